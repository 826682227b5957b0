"""Where things are, and how far it is from one to the other."""

from collections.abc import Sequence
from math import hypot

Point = tuple[float, float]


def distances_m(points: Sequence[Point], distance: str) -> tuple[tuple[float, ...], ...]:
    """(P, P) metres between points in a straight line (``euclidean``) or along the axes (``rectilinear``)."""
    measure = {"euclidean": _euclidean_m, "rectilinear": _rectilinear_m}[distance]
    return tuple(tuple(measure(a, b) for b in points) for a in points)


def _euclidean_m(a: Point, b: Point) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])


def _rectilinear_m(a: Point, b: Point) -> float:
    return abs(a[0] - b[0]) + abs(a[1] - b[1])
