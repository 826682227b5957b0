"""Which way benches face, where a layout leaves that open: to where least stands.

The floor that a layout leaves open: benches before those who work at a place, turned to where there is room.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import atan2, cos, exp, hypot, inf, pi, sin
from typing import Any, NamedTuple

import numpy as np

from opsim.plan import Plan
from opsim.subjects.stations.plan import CONVEYOR, STATION, STORE
from opsim.viewer.scene import NONE, Belt, Bench, Pile

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


HEIGHT_M, WIDTH_M = 0.9, 1.4
"""How high, unless its place says so, and, for one who works at it, wide a bench is."""
ABOVE_M = 0.35
"""From the highest board of a rack to its top."""
BESIDE_M, BEHIND_M = 0.8, 0.9
"""From one to the next who stands beside or behind him."""


@dataclass(frozen=True)
class Post:
    """Where a station is worked at: its place, the way one faces, and how far to the left of the place that is."""

    place: int
    facing_rad: float
    left_m: float


@dataclass(frozen=True)
class Floor:
    """points_m : of the places; facing_rad : the way one looks who stands at each

    posts : by the rank of a station; posts_at : how many there are at each place
    """

    points_m: tuple[Point, ...]
    facing_rad: tuple[float, ...]
    posts: dict[int, Post]
    posts_at: tuple[int, ...]
    benches: tuple[Bench, ...]
    piles: tuple[Pile, ...]
    belts: tuple[Belt, ...]

    def spot_m(self, place: int, facing_rad: float, left_m: float, back_m: float = 0.0) -> Point:
        """A point near a place, as seen by who looks that way there."""
        (x, y), (c, s) = self.points_m[place], (cos(facing_rad), sin(facing_rad))
        return x - left_m * s - back_m * c, y + left_m * c - back_m * s


def floor_of(plan: Plan, layout: Any, like: tuple[Plan, Any] | None = None) -> Floor:
    """The places of a layout with the benches, stores and belts of a plan.

    like : plan and layout of another variant: what stands there as it does here faces the same way
    """
    here = _site(plan, layout)
    points, facing = here.points_m, facings(here, {} if like is None else kept(here, _site(*like)))
    posts: dict[int, Post] = {}
    at = [0] * len(points)
    places = [layout.with_heights.get(name) for name in plan.places]
    for rank, station in enumerate(plan.stations):
        if station.kind == STATION:
            number = 0 if _is_rack(places[station.place]) else at[station.place]
            posts[rank] = _post(station.place, number, facing[station.place])
            at[station.place] += 1
    bare = Floor(points, facing, posts, tuple(at), (), (), ())
    benches = tuple(_bench(bare, plan, rank, places[posts[rank].place]) for rank in posts)
    return Floor(points, facing, posts, tuple(at), benches, _piles(bare, plan), _belts(bare, plan))


def drawn_as(plan: Plan) -> np.ndarray:
    """(stations + 1,) the number of each station among benches, then piles, then belts; last: NONE, for rank NONE."""
    kinds = [(STATION, STORE, CONVEYOR).index(station.kind) for station in plan.stations]
    found = np.full(len(kinds) + 1, NONE)
    found[np.argsort(kinds, kind="stable")] = np.arange(len(kinds))
    return found


def roads_of(layout: Any) -> tuple[tuple[float, float, float, float], ...]:
    """(x, y, x, y) of every path of a layout that has paths, in metres."""
    return tuple((*a, *b) for a, b in _roads(layout))


def _site(plan: Plan, layout: Any) -> Site:
    return Site(plan.places, tuple(layout.places[name] for name in plan.places), _roads(layout))


def _roads(layout: Any) -> list[tuple[Point, Point]]:
    if layout.distance != "paths":
        return []
    return [(layout.places[step.start], layout.places[step.end]) for step in layout.path_steps]


def _post(place: int, number: int, facing_rad: float) -> Post:
    """The first two stations of a place stand before and behind who works there, further ones beside them."""
    side = facing_rad if number % 2 == 0 else facing_rad + pi
    left_m = (number // 2) * (WIDTH_M + 2 * BESIDE_M)
    return Post(place, (side + pi) % (2 * pi) - pi, left_m if number % 2 == 0 else -left_m)


def _is_rack(place: Any) -> bool:
    """Whether a place has levels: its stations share one rack, of which each is a bay, and people stand before it."""
    return place is not None and bool(place.levels_m)


def _bench(floor: Floor, plan: Plan, rank: int, place: Any) -> Bench:
    """place : what the layout says of its heights, or None"""
    station, post = plan.stations[rank], floor.posts[rank]
    sharing = [other for other, one in floor.posts.items() if one.place == post.place] if _is_rack(place) else [rank]
    tasks = [plan.tasks[task] for task in station.tasks]
    together = sum(_abreast(plan, other) for other in sharing)
    whole_m, bay = min(WIDTH_M + BESIDE_M * (together - 1), 5 * WIDTH_M), sharing.index(rank)
    width_m = whole_m / len(sharing)
    left_m, beside_m = post.left_m + width_m * (bay + 0.5) - whole_m / 2, post.left_m + whole_m / 2 + 0.5 + 1.1 * bay
    x, y = floor.spot_m(post.place, post.facing_rad, left_m, -AHEAD_M - DEPTH_M / 2)
    buffer_m = floor.spot_m(post.place, post.facing_rad, beside_m, -AHEAD_M - DEPTH_M / 2)
    alone = bool(tasks) and all(task.automatic for task in tasks)
    holds = None if station.buffer == inf else int(station.buffer)
    levels_m = tuple(sorted(place.heights_m.values())) if _is_rack(place) else ()
    surface_m = HEIGHT_M if place is None or place.surface_m is None else place.surface_m
    high_m = levels_m[-1] + ABOVE_M if levels_m else surface_m
    return Bench(
        *(station.name, station.place, x, y, post.facing_rad, width_m, DEPTH_M, high_m, alone, buffer_m, holds),
        levels_m,
    )


def _abreast(plan: Plan, station: int) -> int:
    """How many work side by side at a station."""
    of = plan.stations[station]
    return max([of.servers, *(plan.tasks[task].team for task in of.tasks)])


def _piles(floor: Floor, plan: Plan) -> tuple[Pile, ...]:
    """Stores lie before who comes to their place; beside the benches, where there are some."""
    piles, lie = [], [0] * len(floor.points_m)
    for station in plan.stations:
        if station.kind == STORE:
            place = station.place
            beside = lie[place] if not floor.posts_at[place] else lie[place] + 1.5
            x, y = floor.spot_m(place, floor.facing_rad[place], -1.4 * beside, -AHEAD_M - DEPTH_M / 2)
            lie[place] += 1
            piles.append(Pile(station.name, x, y, None if station.capacity == inf else int(station.capacity)))
    return tuple(piles)


def _belts(floor: Floor, plan: Plan) -> tuple[Belt, ...]:
    ends = {belt.station: belt.place_to for belt in plan.conveyors}
    return tuple(
        Belt(station.name, (_front_m(floor, station.place), _front_m(floor, ends[rank])))
        for rank, station in enumerate(plan.stations)
        if station.kind == CONVEYOR
    )


def _front_m(floor: Floor, place: int) -> Point:
    return ahead_m(floor.points_m[place], floor.facing_rad[place])
