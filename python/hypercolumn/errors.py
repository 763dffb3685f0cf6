# SPDX-License-Identifier: Apache-2.0
"""Exceptions."""

import pathlib
import sys


class Error(RuntimeError):
    """An error of the world outside the program, with the text of C++ and commands.

    Raised in a handler, it ends the module with this one line and status 1; with the code "Invalid"
    with status 2, since a restart would fail again.

    `code` is one of Malformed, Unsupported, TooLarge, Truncated, Closed, Stopped, NotFound, Invalid,
    System, as in doc/reference.md; or empty.
    """

    def __init__(self, text: str, code: str = "") -> None:
        super().__init__(text)
        self.code = code


class BadMessage(Exception):
    """Raised in a handler to refuse a message.

    The message is dropped, counted, and logged once per input; the module continues.
    """


class Stopped(BaseException):
    """Ends the module cleanly: its outputs have no reader any more, or it was asked to stop.

    Like KeyboardInterrupt, it is not caught by `except Exception`.
    """


def other_python() -> str:
    """The error if the package was not built, or for another version of Python."""
    folder = pathlib.Path(__file__).parent
    built = ", ".join(sorted(path.name for path in folder.glob("_hypercolumn.*.so")))
    if not built:
        return "the Python package in %s is not built: build it with ./dev build" % folder
    return (
        "hypercolumn was built for another Python than %s (%d.%d): %s has %s; start the program with "
        "that Python, or build with cmake -D Python_EXECUTABLE=%s"
        % (sys.executable, *sys.version_info[:2], folder, built, sys.executable)
    )


def no_numpy() -> str:
    """The error if this Python has no numpy."""
    return (
        "hypercolumn needs numpy, which %s does not have: start the program with a Python that does, "
        "such as /usr/bin/python3 with Debian's python3-numpy" % sys.executable
    )
