"""Which way benches face, where a layout leaves that open: to where least stands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, cos, exp, hypot, pi, sin
from typing import NamedTuple

import numpy as np

Point = tuple[float, float]
AHEAD_M, DEPTH_M = 0.42, 0.7
"""From who stands there to the edge of a bench; how deep it is."""
NEAR_M = 4.0
"""A bench faces as in another variant where nothing so near has come, gone or moved."""
FAR_M, AWAY, ALIKE, ACROSS = 2.0, 0.1, 0.3, 0.2
"""How far things shun each other; what it counts that a bench looks away from the middle of the floor, stands as the
nearest one does, and stands across the page."""
SIDES = (pi / 2, -pi / 2, 0.0, pi)


class Site(NamedTuple):
    """The places of a layout and the roads between them."""

    names: Sequence[str]
    points_m: tuple[Point, ...]
    roads: list[tuple[Point, Point]]


def kept(here: Site, there: Site) -> dict[str, float]:
    """How places face that are here as they are there, and everything near them too."""
    faces = dict(zip(there.names, facings(there, {})))
    same = set(zip(here.names, here.points_m)) & set(zip(there.names, there.points_m))
    return {name: faces[name] for name, point in sorted(same) if _near(here, point) == _near(there, point)}


def _near(site: Site, point: Point) -> tuple[set[Point], set[tuple[Point, Point]]]:
    points = {other for other in site.points_m if hypot(other[0] - point[0], other[1] - point[1]) < NEAR_M}
    return points, {road for road in site.roads if _from_road_m(point, *road) < NEAR_M}


def facings(site: Site, known: Mapping[str, float]) -> tuple[float, ...]:
    """The way one looks at each place: to where least stands, rather outwards, and rather as the neighbour does.

    known : of places by name that are not asked about
    """
    points, roads = site.points_m, site.roads
    middle = np.mean(np.array(points), axis=0)
    found: list[float] = []
    for rank, point in enumerate(points):
        if site.names[rank] in known:
            found.append(known[site.names[rank]])
            continue
        others = [other for other in points if other != point]
        stand = [ahead_m(points[k], found[k]) for k in range(rank) if points[k] != point]
        outwards = atan2(point[1] - middle[1], point[0] - middle[0])
        nearest = min(
            range(rank), key=lambda k: (hypot(points[k][0] - point[0], points[k][1] - point[1]), k), default=-1
        )
        costs = [
            _cost(ahead_m(point, side), others, stand, roads)
            - AWAY * cos(side - outwards)
            - (ALIKE if nearest >= 0 and found[nearest] == side else 0.0)
            + ACROSS * abs(cos(side))
            for side in SIDES
        ]
        found.append(SIDES[min(range(len(SIDES)), key=lambda k: (round(costs[k], 6), k))])
    return tuple(found)


def ahead_m(point: Point, facing_rad: float) -> Point:
    far = AHEAD_M + DEPTH_M / 2
    return point[0] + far * cos(facing_rad), point[1] + far * sin(facing_rad)


def _cost(bench: Point, others: Sequence[Point], stand: Sequence[Point], roads: Sequence[tuple[Point, Point]]) -> float:
    near = sum(exp(-hypot(bench[0] - x, bench[1] - y) / FAR_M) for x, y in (*others, *stand))
    return near + sum(5.0 * exp(-_from_road_m(bench, *road) / (AHEAD_M + DEPTH_M)) for road in roads)


def _from_road_m(point: Point, a: Point, b: Point) -> float:
    along = (b[0] - a[0], b[1] - a[1])
    length = along[0] ** 2 + along[1] ** 2
    share = 0.0 if length == 0 else ((point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1]) / length
    share = min(max(share, 0.0), 1.0)
    return hypot(a[0] + share * along[0] - point[0], a[1] + share * along[1] - point[1])
