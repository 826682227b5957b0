"""Ways over the floor: from spot to spot past the places between, and where on one, looking which way, somebody is.

Tasks that lead somewhere: who carries something three metres begins so far from the bench that he ends before it.

Where an operation goes to and fro (pick up, bring, put down, go back) the first way leads away from the bench and the
next one back, and what is done between is done where he is. Where it goes one way only, each begins at the far end.

Visits: the stretches in which somebody stays at a place, and the spot where he stands meanwhile.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import groupby, pairwise
from math import hypot
from typing import Any, NamedTuple

import numpy as np

from opsim.history import Whereabouts
from opsim.log import ABSENT, OFF, REPAIR, SETUP, WALK, WORK, EventLog
from opsim.plan import Plan
from opsim.viewer.floor import BEHIND_M, BESIDE_M, Floor
from opsim.viewer.scene import Ways
from opsim.viewer.skeletons import turned

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


Frames = tuple[np.ndarray, np.ndarray, np.ndarray]
"""x, y in metres and heading of each row."""


class Doing(NamedTuple):
    """Rows of whereabouts in which something is performed, (R,) each, by worker and time.

    far_m : (R, 2) how far the performance leads, in its own frame; 0 where it does not
    """

    row: np.ndarray
    worker: np.ndarray
    station: np.ndarray
    job: np.ndarray
    performance: np.ndarray
    far_m: np.ndarray


def placed(doing: Doing, frames: Frames) -> Frames:
    """The frames of whereabouts with those of ``doing`` put where they lead to the bench, or from it."""
    x, y, yaw = (column.copy() for column in frames)
    going = set(doing.station[doing.far_m.any(axis=1)].tolist())
    operations = [which for which in _operations(doing) if int(doing.station[which[0]]) in going]
    to_and_fro = _to_and_fro(doing, operations)
    for which in operations:
        returns = int(doing.station[which[0]]) in to_and_fro
        for row, back_m, turn in _steps(doing, which, returns):
            shift = turned(np.array([*back_m, 0.0]), yaw[row])
            x[row], y[row], yaw[row] = x[row] - shift[0], y[row] - shift[1], yaw[row] + turn
    return x, y, yaw


def _operations(doing: Doing) -> Iterator[list[int]]:
    """What one worker does of one job at one station, one after the other."""
    of = list(zip(doing.worker.tolist(), doing.station.tolist(), doing.job.tolist()))
    for _, which in groupby(range(len(of)), of.__getitem__):
        yield list(which)


def _to_and_fro(doing: Doing, operations: list[list[int]]) -> set[int]:
    """Stations whose operations mostly have an even number of ways."""
    ways: dict[int, Counter[int]] = {}
    for which in operations:
        far = {int(doing.performance[k]) for k in which if doing.far_m[k].any()}
        ways.setdefault(int(doing.station[which[0]]), Counter())[len(far)] += 1
    return {station for station, n in ways.items() if n.most_common(1)[0][0] % 2 == 0}


def _steps(doing: Doing, which: list[int], returns: bool) -> Iterator[tuple[int, np.ndarray, float]]:
    """(row, how far before the bench its frame begins, how much it is turned) of each piece of an operation."""
    away, at_m = False, np.zeros(2)
    for _, pieces in groupby(which, lambda k: int(doing.performance[k])):
        same = list(pieces)
        far_m = doing.far_m[same[0]]
        leads = bool(far_m.any())
        if leads and not returns:
            away, at_m = True, far_m
        for k in same:
            turn = np.pi if away != leads else 0.0
            yield int(doing.row[k]), at_m if away else np.zeros(2), turn
        if leads:
            away, at_m = not away, far_m


ABREAST = 5
"""People who do not work and stand beside each other before a row behind them begins."""


class Spots(NamedTuple):
    """Where who is at a place stands, row by row of some whereabouts, (R,) each; nan where nobody is on the floor, or
    somebody walks.

    dx_m, dy_m : how far he is carried until the end of the row
    """

    x_m: np.ndarray
    y_m: np.ndarray
    yaw_rad: np.ndarray
    dx_m: np.ndarray
    dy_m: np.ndarray


@dataclass(frozen=True)
class Visit:
    """Rows begin to end of whereabouts, at one place; works : whether anything is done there by him."""

    begin: int
    end: int
    worker: int
    place: int
    start_s: float
    end_s: float
    works: bool


def spots_of(log: EventLog, plan: Plan, seen: Whereabouts, floor: Floor) -> Spots:
    """Everybody beside those who are there already: who works before the bench, others behind him.

    A spot is kept for a whole visit, and taken again by who had it last if it is free.
    """
    station = log["station"][seen.row]
    at_work = np.isin(seen.kind, (WORK, SETUP, REPAIR)) & (station >= 0)
    x, y, yaw = (np.full(seen.row.size, np.nan) for _ in range(3))
    taken = _Taken(len(plan.places))
    for visit in sorted(_visits(seen, at_work), key=lambda visit: (visit.start_s, visit.worker)):
        slot = taken.slot(visit)
        rows = slice(visit.begin, visit.end)
        facing = _facings(floor, visit.place, station[rows], at_work[rows])
        for facing_rad, left_m in set(facing):
            here = [visit.begin + k for k, found in enumerate(facing) if found == (facing_rad, left_m)]
            x[here], y[here] = _spot_m(floor, visit, slot, facing_rad, left_m)
            yaw[here] = facing_rad
    return Spots(x, y, yaw, np.zeros(x.size), np.zeros(x.size))


def _visits(seen: Whereabouts, at_work: np.ndarray) -> Iterator[Visit]:
    """Rows of one worker one after the other at one place; ways and absence are none."""
    away = np.isin(seen.kind, (OFF, ABSENT)) | ((seen.kind == WALK) & (seen.place_from != seen.place_to))
    place = np.where(away, -1, seen.place_from)
    edges = np.flatnonzero((np.diff(place) != 0) | (np.diff(seen.worker) != 0)) + 1
    work = np.r_[0, np.cumsum(at_work)]
    for begin, end in zip(np.r_[0, edges].tolist(), np.r_[edges, place.size].tolist()):
        if place.size and place[begin] >= 0:
            times = float(seen.start_s[begin]), float(seen.end_s[end - 1])
            works = bool(work[end] > work[begin])
            yield Visit(begin, end, int(seen.worker[begin]), int(place[begin]), *times, works)


class _Taken:
    """Which slots are taken, place by place, of those who work and of the others."""

    def __init__(self, n_places: int):
        self._leaving: list[list[tuple[float, int, bool]]] = [[] for _ in range(n_places)]
        self._used: list[dict[bool, set[int]]] = [{True: set(), False: set()} for _ in range(n_places)]
        self._last: dict[tuple[int, int, bool], int] = {}

    def slot(self, visit: Visit) -> int:
        """The one he had last, or the first that is free."""
        leaving, used = self._leaving[visit.place], self._used[visit.place]
        while leaving and leaving[0][0] <= visit.start_s:
            _, gone, worked = heappop(leaving)
            used[worked].discard(gone)
        mine = self._last.get((visit.worker, visit.place, visit.works), 0)
        # NOTE: who had the first slot once is not kept to a further one: the middle of the bench is the place itself
        slot = mine if mine not in used[visit.works] else next(k for k in range(10**6) if k not in used[visit.works])
        if 0 not in used[visit.works]:
            slot = 0
        used[visit.works].add(slot)
        heappush(leaving, (visit.end_s, slot, visit.works))
        self._last[visit.worker, visit.place, visit.works] = slot
        return slot


def _facings(floor: Floor, place: int, station: np.ndarray, at_work: np.ndarray) -> list[tuple[float, float]]:
    """(facing, metres to the left of the place) of each row of a visit: of the post worked at last, or next."""
    posts = [floor.posts.get(int(s)) if works else None for s, works in zip(station, at_work)]
    usual = floor.facing_rad[place], 0.0
    found, last = [], next(((p.facing_rad, p.left_m) for p in posts if p is not None), usual)
    for post in posts:
        last = last if post is None else (post.facing_rad, post.left_m)
        found.append(last)
    return found


def _spot_m(floor: Floor, visit: Visit, slot: int, facing_rad: float, left_m: float) -> tuple[float, float]:
    """Slots from the middle outwards, to the left and to the right by turns."""
    if visit.works:
        return floor.spot_m(visit.place, facing_rad, left_m + _aside_m(slot))
    row, column = divmod(slot, ABREAST)
    behind = row if not floor.posts_at[visit.place] else row + 1
    return floor.spot_m(visit.place, facing_rad, left_m + _aside_m(column), BEHIND_M * behind)


def _aside_m(slot: int) -> float:
    return BESIDE_M * ((slot + 1) // 2) * (1 if slot % 2 else -1)
