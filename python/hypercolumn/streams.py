# SPDX-License-Identifier: Apache-2.0
"""Messages of recordings and links, for scripts and notebooks."""

import os
from typing import Optional, Union

from hypercolumn._hypercolumn import Stream


def open(uri: str, *, limit: Optional[int] = None) -> Stream:
    """The messages of a link, as `hc cat` takes it: "tcp:robot:7000", "shm:NAME", "-".

        with hc.open("unix:/tmp/eye?wait=10") as messages:
            for message in messages:
                print(message.matrix.mean())

    They come one after the other until the link ends; Ctrl-C ends a wait. What is compressed has
    been expanded. `limit` is the largest size of a message's elements that is accepted [byte].
    """
    return Stream(uri, limit)


def read(
    path: "Union[str, os.PathLike[str]]", stream: str = "", *, limit: Optional[int] = None
) -> Stream:
    """The messages of a recording in the order in which they were recorded: a file of MTP/1; one in
    MCAP whose name ends in ".mcap"; or the folder of `hc run --record`. `stream` chooses one of the
    latter two, as "head_eyes.left"."""
    file = "file:" + os.fspath(path)
    return Stream(file + ("?stream=" + stream if stream else ""), limit)
