# SPDX-License-Identifier: Apache-2.0
"""Messages of recordings and links, for scripts and notebooks."""

import os
from typing import Optional, Union

from hypercolumn._hypercolumn import Stream
from hypercolumn.errors import Error


def open(uri: str, *, limit: Optional[int] = None) -> Stream:
    """The messages of a link, as `hc cat` takes it: "tcp:robot:7000", "shm:NAME", "-".

        with hc.open("unix:/tmp/eye?wait=10") as messages:
            for message in messages:
                print(message.array.mean())

    They come one after the other until the link ends; Ctrl-C ends a wait. What is compressed has
    been expanded. `limit` is the largest size of a message's elements that is accepted [byte].
    """
    return Stream(uri, limit)


def read(
    path: "Union[str, os.PathLike[str]]", stream: str = "", *, limit: Optional[int] = None
) -> Stream:
    """The messages of a recording in their order: a file of MTP/1; one in MCAP whose name ends in
    ".mcap"; or the folder of `hc run --record`. `stream` chooses one of the latter two, as
    "head_eyes.left"; a folder with several needs it."""
    file = os.fspath(path)
    if os.path.isdir(file):
        return Stream("file:" + _file_of(file, stream), limit)
    return Stream("file:" + file + ("?stream=" + stream if stream else ""), limit)


def _file_of(folder: str, stream: str) -> str:
    """The file of a stream in a folder of recordings."""
    names = sorted(name[:-4] for name in os.listdir(folder) if name.endswith(".mtp"))
    wanted = stream or (names[0] if len(names) == 1 else "")
    if wanted in names:
        return os.path.join(folder, wanted + ".mtp")
    has = "it has " + ", ".join(names) if names else "it has none"
    if wanted:
        raise Error("NotFound: %s: no stream %s; %s" % (folder, wanted, has), "NotFound")
    raise Error("Invalid: %s is a folder; say which stream: %s" % (folder, has), "Invalid")
