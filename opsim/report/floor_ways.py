"""Ways over the floor as lines: which points one passes between two places of a layout."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from opsim.layout import Ways, ways

Point = tuple[float, float]
Line = tuple[Point, ...]


class FloorWays:
    """Of a layout. distance : how a way is measured; places : points in metres by name"""

    def __init__(self, layout: Any) -> None:
        self.distance: str = layout.distance
        self.places: dict[str, Point] = {name: tuple(at) for name, at in layout.places.items()}
        self._layout = layout

    @cached_property
    def _ways(self) -> Ways:
        return ways(self._layout)

    def passed(self, start: str, end: str) -> tuple[str, ...]:
        """The places on the way, both ends included."""
        if self.distance != "paths" or start == end:
            return (start, end)
        return self._ways.way(start, end)

    def line(self, start: str, end: str) -> Line:
        """The points of the way in metres; along the axes first along x, as the replay walks it."""
        if self.distance != "rectilinear":
            return tuple(self.places[name] for name in self.passed(start, end))
        (x, y), (u, v) = self.places[start], self.places[end]
        return ((x, y), (u, v)) if x == u or y == v else ((x, y), (u, y), (u, v))
