# SPDX-License-Identifier: Apache-2.0
"""What this package raises."""

import pathlib
import sys


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


class BadMessage(Exception):
    """Raised by a handler since the message that it got says what it cannot use.

    That message is dropped, counted and logged, once for each input, and the module goes on.
    """


class Stopped(BaseException):
    """Ends the module cleanly: nobody reads its outputs any more, or it was asked to stop.

    It passes through handlers as KeyboardInterrupt does; no `except Exception` catches it.
    """


def other_python() -> str:
    """Says that the package was built for another version of Python than this one."""
    folder = pathlib.Path(__file__).parent
    built = ", ".join(sorted(path.name for path in folder.glob("_hypercolumn.*.so"))) or "nothing"
    return (
        "hypercolumn was built for another Python than %s (%d.%d): %s has %s; start the program with "
        "the Python of that, or build with cmake -D Python_EXECUTABLE=%s"
        % (sys.executable, *sys.version_info[:2], folder, built, sys.executable)
    )


def no_numpy() -> str:
    """Says that this Python has no numpy."""
    return (
        "hypercolumn needs numpy, which %s does not have: start the program with a Python that does, "
        "such as /usr/bin/python3 with Debian's python3-numpy" % sys.executable
    )
