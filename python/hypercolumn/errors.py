# SPDX-License-Identifier: Apache-2.0
"""What this package raises."""


class Error(RuntimeError):
    """A failure of the world, with the text that C++ and the commands have for it.

    Raised by a handler, it ends the module with this one line and status 1; with the code "Invalid"
    with status 2, since a restart would fail again.

    `code` is one of Malformed, Unsupported, TooLarge, Truncated, Closed, Stopped, NotFound, Invalid,
    System, as in doc/reference.md; or empty.
    """

    def __init__(self, text: str, code: str = "") -> None:
        super().__init__(text)
        self.code = code


class Stopped(BaseException):
    """Ends the module cleanly: nobody reads its outputs any more, or it was asked to stop.

    It passes through handlers as KeyboardInterrupt does; no `except Exception` catches it.
    """
