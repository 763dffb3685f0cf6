# SPDX-License-Identifier: Apache-2.0
"""Kinds of messages that a port accepts or sends.

    hc.rotation().of(1, 1).in_("gaze").finite()   # one rotation, in the coordinate system gaze

`scalar` is the type of the numbers: "u8" … "f64" as in the specification, or anything that numpy
accepts as dtype. Shapes are as in numpy: height first.
"""

from typing import Any, Dict

from hypercolumn import _hypercolumn
from hypercolumn._hypercolumn import Kind


def position(components: int = 3, scalar: Any = "f64") -> Kind:
    """Positions x y z; 6 or 9 components carry velocity and acceleration too."""
    return _hypercolumn.kind("position", components, scalar)


def rotation(components: int = 3, scalar: Any = "f64") -> Kind:
    """Rotations roll, pitch, yaw [rad]; 6 or 9 components carry rates and accelerations too."""
    return _hypercolumn.kind("rotation", components, scalar)


def rgb_image(scalar: Any = "u8") -> Kind:
    """A colour image, (height, width, 3): red, green, blue."""
    return _hypercolumn.kind("rgb_image", 3, scalar)


def intensity_image(scalar: Any = "u8") -> Kind:
    """A grey image or a depth map, (height, width)."""
    return _hypercolumn.kind("intensity_image", 1, scalar)


def image() -> Kind:
    """An image of bytes, in colour or grey, for an input: (height, width, 3) or (height, width)."""
    return _hypercolumn.any_of(rgb_image(), intensity_image())


def vector_field(components: int, scalar: Any = "f32") -> Kind:
    """A vector for each cell of a grid, (height, width, components)."""
    return _hypercolumn.kind("vector_field", components, scalar)


def string() -> Kind:
    """UTF-8 text."""
    return _hypercolumn.kind("string", 1, "u8")


def transformation(height: int = 4, width: int = 4, scalar: Any = "f64") -> Kind:
    """A matrix on homogeneous coordinates: (4, 4) a pose."""
    return _hypercolumn.kind("transformation", 1, scalar).of(height, width)


def dense_graph(components: int = 1, scalar: Any = "f64") -> Kind:
    """Weights of all edges of a graph, (nodes, nodes, components)."""
    return _hypercolumn.kind("dense_graph", components, scalar)


def sparse_graph(components: int = 3, scalar: Any = "f64") -> Kind:
    """Edges of a graph, (edges, 1, components): from, to, then weights."""
    return _hypercolumn.kind("sparse_graph", components, scalar)


def sound(channels: int, scalar: Any = "i16") -> Kind:
    """Sample frames, (1, frames, channels)."""
    return _hypercolumn.kind("sound", channels, scalar)


def map(components: int = 1, scalar: Any = "f64") -> Kind:
    """A grid map of an area, (height, width, components): occupancy, cost, place cells."""
    return _hypercolumn.kind("map", components, scalar)


def table(components: int = 1, scalar: Any = "f64") -> Kind:
    """Other numbers: counters, scores, bids."""
    return _hypercolumn.kind("table", components, scalar)


def any_of(*kinds: Kind) -> Kind:
    """Several kinds for one input; message.type and message.scalar tell which one arrived."""
    return _hypercolumn.any_of(*kinds)


def anything() -> Kind:
    """Any kind of message, for an input."""
    return _hypercolumn.any_of()


def coords() -> Dict[str, int]:
    """Numbers of the coordinate systems of the specification, by name."""
    return _hypercolumn.coords()
