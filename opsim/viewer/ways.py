"""Ways over the floor: from spot to spot past the places between, and where on one, looking which way, somebody is."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np

from opsim.viewer.scene import Ways

Point = tuple[float, float]
CORNER_M = 0.35
"""So long before and after a corner who walks turns."""
TURN_S = 0.4
"""So long, or a third of the whole, it takes to turn from a bench to the way, and to ease from one posture to the
next."""
SAME_M = 1e-3
HALF_TURN_RAD = 1e-4
HALF_M = 0.6
"""What has to be free beside the middle of a bench."""


class Routes:
    """The points of ways between places, each found once.

    passed : ``opsim.layout.Ways`` of the layout; benches_m : what ways along the axes rather lead around
    """

    def __init__(self, passed: Any, layout: Any, benches_m: Sequence[Point] = ()):
        self._passed, self._points_m = passed, [layout.places[name] for name in passed.places]
        self._along_axes, self._benches_m = layout.distance == "rectilinear", benches_m
        self._between: dict[tuple[int, int], list[Point]] = {}
        self._axes: dict[tuple[Point, Point], list[Point]] = {}

    def points_m(self, start: Point, end: Point, place_from: int, place_to: int) -> list[Point]:
        """From a spot at a place to one at another, corners between; two points at least."""
        if not self._along_axes:
            return without_doubles([start, *self._passed_between(place_from, place_to), end])
        if (start, end) not in self._axes:
            self._axes[start, end] = _along_axes(start, end, self._benches_m)
        return self._axes[start, end]

    def _passed_between(self, place_from: int, place_to: int) -> list[Point]:
        key = place_from, place_to
        if key not in self._between:
            names = self._passed.places
            way = self._passed.way(names[place_from], names[place_to]) if place_from != place_to else ()
            self._between[key] = [self._points_m[names.index(name)] for name in way[1:-1]]
        return self._between[key]


def _along_axes(start: Point, end: Point, benches_m: Sequence[Point]) -> list[Point]:
    """Of the ways along the axes, all of one length, the one that leads through fewest benches; rather few corners."""
    (x, y), (u, v) = start, end
    across, up = (x + u) / 2, (y + v) / 2
    offers = [[(u, y)], [(x, v)], [(across, y), (across, v)], [(x, up), (u, up)]]
    ways = [without_doubles([start, *corners, end]) for corners in offers]
    return min(ways, key=lambda way: sum(_through(way, bench) for bench in benches_m))


def _through(way: Sequence[Point], bench: Point) -> bool:
    """Whether a way along the axes comes nearer to the middle of a bench than HALF_M both along and across."""
    return any(
        min(a[0], b[0]) - HALF_M < bench[0] < max(a[0], b[0]) + HALF_M
        and min(a[1], b[1]) - HALF_M < bench[1] < max(a[1], b[1]) + HALF_M
        for a, b in pairwise(way)
    )


def without_doubles(points: Sequence[Point]) -> list[Point]:
    """The points without those where nothing goes on; of a way that goes nowhere its two ends."""
    kept = [points[0]]
    for point in points[1:-1]:
        if hypot(point[0] - kept[-1][0], point[1] - kept[-1][1]) > SAME_M:
            kept.append(point)
    last = points[-1]
    if len(kept) > 1 and hypot(last[0] - kept[-1][0], last[1] - kept[-1][1]) <= SAME_M:
        kept.pop()
    return [*kept, last]


def length_m(points: Sequence[Point]) -> float:
    """How long a way is."""
    return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points))


class WayList:
    """Ways as they are found, and at last as columns."""

    def __init__(self) -> None:
        self._points: list[list[Point]] = []
        self._more: list[list[float]] = []

    def add(self, points: list[Point], own_m: float = 0.0, yaw: tuple[float, float] = (np.nan, np.nan)) -> int:
        """One more; its number."""
        self._points.append(points)
        self._more.append([own_m, *yaw])
        return len(self._points) - 1

    def walked(self, way: int, own_m: float) -> None:
        """The walk that goes a way is so long in its own frame."""
        self._more[way][0] = own_m

    def close(self) -> Ways:
        """All of them."""
        first = np.cumsum([0, *map(len, self._points)]).astype(np.uint32)
        xy = np.array([point for points in self._points for point in points], dtype=float).reshape(-1, 2)
        own_m, yaw_from, yaw_to = np.array(self._more, dtype=float).reshape(-1, 3).T
        return Ways(first, xy[:, 0], xy[:, 1], own_m, yaw_from, yaw_to)


def at_m(points: np.ndarray, s_m: float) -> tuple[np.ndarray, float]:
    """((2,) the point s metres along a way (P, 2), the heading there); corners are rounded for the eye alone.

    The heading is a leg's own; within CORNER_M of a corner, or half of either leg, it turns evenly the shorter way.
    """
    legs = np.diff(points, axis=0)
    long_m = np.hypot(legs[:, 0], legs[:, 1])
    ends_m = np.cumsum(long_m)
    s_m = min(max(s_m, 0.0), float(ends_m[-1]))
    leg = min(int(np.searchsorted(ends_m, s_m, side="right")), len(legs) - 1)
    into_m = s_m - (ends_m[leg] - long_m[leg])
    share = into_m / long_m[leg] if long_m[leg] > 0 else 0.0
    heading = _heading(legs, leg)
    for corner, past_m in ((leg, into_m - long_m[leg]), (leg - 1, into_m)):
        if 0 <= corner < len(legs) - 1:
            reach_m = min(CORNER_M, 0.5 * long_m[corner], 0.5 * long_m[corner + 1])
            if abs(past_m) < reach_m:
                before, after = _heading(legs, corner), _heading(legs, corner + 1)
                heading = before + wrapped(after - before) * 0.5 * (1.0 + past_m / reach_m)
    return points[leg] + share * legs[leg], float(heading)


def eased_heading(heading: float, begun_s: float, left_s: float, whole_s: float, yaw: tuple[float, float]) -> float:
    """The heading of a way at a time after its start and before its end, turned from and to how one stood.

    yaw : before and after; nan: as the way goes
    """
    ease_s = min(TURN_S, whole_s / 3)
    if begun_s < ease_s and not np.isnan(yaw[0]):
        return yaw[0] + wrapped(heading - yaw[0]) * smooth(begun_s / ease_s)
    if left_s < ease_s and not np.isnan(yaw[1]):
        return yaw[1] + wrapped(heading - yaw[1]) * smooth(left_s / ease_s)
    return heading


def smooth(share: float) -> float:
    """0 to 1, slope 0 at both ends."""
    share = min(max(share, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


def wrapped(angle: float) -> float:
    """The same turn the shorter way round; half a turn, and what comes within HALF_TURN_RAD of it, to the left.

    NOTE: half turns are common, and a page that keeps headings as float32 has to take them the same way round.
    """
    return float((angle + np.pi - HALF_TURN_RAD) % (2 * np.pi) - np.pi + HALF_TURN_RAD)


def _heading(legs: np.ndarray, leg: int) -> float:
    return float(np.arctan2(legs[leg, 1], legs[leg, 0]))
