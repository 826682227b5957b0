"""Vectors of three numbers, as tuples: nothing is allocated. What has no direction is nan, as in ``frames.py``."""

from __future__ import annotations

import math

from opsim.ergonomics.kernels.compiled import compiled

SHORTEST_SQUARED = 1e-6**2
NO_PLANE_SQUARED = 1e-6**2
"""``frames.SHORTEST_M`` and ``angles.NO_PLANE``, squared."""


@compiled(error_model="numpy", nogil=True)
def way(a, b):
    """From point a to point b."""
    return b[0] - a[0], b[1] - a[1], b[2] - a[2]


@compiled(error_model="numpy", nogil=True)
def unit(v):
    """v at length 1; nan where it is shorter than 1e-6."""
    squared = dot(v, v)
    over = 1.0 / math.sqrt(squared) if squared >= SHORTEST_SQUARED else math.nan
    return v[0] * over, v[1] * over, v[2] * over


@compiled(error_model="numpy", nogil=True)
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled(error_model="numpy", nogil=True)
def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled(error_model="numpy", nogil=True)
def within(frame, v):
    """v in the axes of a frame (x, y, z)."""
    return dot(frame[0], v), dot(frame[1], v), dot(frame[2], v)


@compiled(error_model="numpy", nogil=True)
def in_plane(opposite, adjacent):
    """adjacent, or nan where a unit vector has too little in this plane for an angle there."""
    return adjacent if opposite * opposite + adjacent * adjacent >= NO_PLANE_SQUARED else math.nan


@compiled(error_model="numpy", nogil=True)
def beyond_plane(x, z):
    """What stands square to y: with y it makes the angle out of the plane of x and z."""
    return math.sqrt(x * x + z * z)
