# SPDX-License-Identifier: Apache-2.0
"""Hypercolumn in Python: modules, messages as numpy arrays, recordings, and graphs that run.

    import hypercolumn as hc

    module = hc.Module("double", "Doubles numbers.")
    numbers = module.input("numbers", hc.table(), "any numbers")
    twice = module.output("twice", hc.table(), "twice as much")

    @module.on(numbers)
    def double(message):
        twice.send(2 * message.matrix)

    module.run()

doc/python.md is a ten-minute tour.
"""

import importlib.util

from hypercolumn.errors import BadMessage, Error, Stopped, no_numpy, other_python

if importlib.util.find_spec("numpy") is None:
    raise ImportError(no_numpy())
try:
    from hypercolumn._hypercolumn import (
        Input,
        Kind,
        Loan,
        Message,
        ModuleFrames,
        Output,
        Parameter,
        Stream,
        Timeout,
    )
except ModuleNotFoundError as missing:
    raise ImportError(other_python()) from missing

from hypercolumn.graphs import Graph, Port, attach, running, start
from hypercolumn.kinds import (
    any_of,
    anything,
    coords,
    dense_graph,
    image,
    intensity_image,
    map,
    position,
    rgb_image,
    rotation,
    sound,
    sparse_graph,
    string,
    table,
    transformation,
    vector_field,
)
from hypercolumn.module import Module, Together, together
from hypercolumn.png import png
from hypercolumn.streams import open, read

setattr(Message, "_repr_png_", png)  # how notebooks show an image

__all__ = [
    "BadMessage",
    "Error",
    "Graph",
    "Input",
    "Kind",
    "Loan",
    "Message",
    "Module",
    "ModuleFrames",
    "Output",
    "Parameter",
    "Port",
    "Stopped",
    "Stream",
    "Timeout",
    "Together",
    "any_of",
    "anything",
    "attach",
    "coords",
    "dense_graph",
    "image",
    "intensity_image",
    "map",
    "open",
    "png",
    "position",
    "read",
    "rgb_image",
    "rotation",
    "running",
    "sound",
    "sparse_graph",
    "start",
    "string",
    "table",
    "together",
    "transformation",
    "vector_field",
]
