# SPDX-License-Identifier: Apache-2.0
"""Holds single threads of a process, as one waits that asked a disk which does not answer."""

import contextlib
import ctypes
import os

SEIZE, INTERRUPT, DETACH = 0x4206, 0x4207, 17  # of ptrace
WALL = 0x40000000  # waits for threads too


def ptrace(request, thread):
    call = ctypes.CDLL(None, use_errno=True).ptrace
    call.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    call.restype = ctypes.c_long
    if call(request, thread, None, None) != 0:
        raise OSError(ctypes.get_errno(), "ptrace")


@contextlib.contextmanager
def held_threads(pid):
    """All threads of a process but the first are stopped meanwhile. For a parent of it, or root."""
    held = []
    try:
        for thread in map(int, os.listdir("/proc/%d/task" % pid)):
            with contextlib.suppress(ProcessLookupError):  # it has just ended
                if thread != pid:
                    ptrace(SEIZE, thread)
                    held.append(thread)
                    ptrace(INTERRUPT, thread)
                    os.waitpid(thread, WALL)
        assert held
        yield
    finally:
        for thread in held:
            with contextlib.suppress(OSError):
                ptrace(DETACH, thread)
