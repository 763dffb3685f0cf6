# SPDX-License-Identifier: Apache-2.0
"""Reads messages of recordings and links, for scripts and notebooks."""

import os
from typing import Optional, Union

from hypercolumn._hypercolumn import Stream


def open(uri: str, *, limit: Optional[int] = None) -> Stream:
    """The messages of a link, as for `hc cat`: "tcp:robot:7000", "shm:NAME", "-".

        with hc.open("unix:/tmp/eye?wait=10") as messages:
            for message in messages:
                print(message.matrix.mean())

    Compressed messages are expanded. Ctrl-C interrupts a wait. `limit` is the maximum accepted size
    of a message's elements [byte].
    """
    return Stream(uri, limit)


def read(
    path: "Union[str, os.PathLike[str]]", stream: str = "", *, limit: Optional[int] = None
) -> Stream:
    """The messages of a recording, in the order recorded: an MTP/1 file, an MCAP file (".mcap"), or
    a folder of `hc run --record`. `stream` selects one stream of the latter two, e.g.
    "head_eyes.left"."""
    file = "file:" + os.fspath(path)
    return Stream(file + ("?stream=" + stream if stream else ""), limit)
