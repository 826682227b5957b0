"""Visits: the stretches in which somebody stays at a place, and the spot where he stands meanwhile."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import NamedTuple

import numpy as np

from opsim.log import ABSENT, OFF, REPAIR, SETUP, WALK, WORK, EventLog
from opsim.plan import Plan
from opsim.viewer.floor import BEHIND_M, BESIDE_M, Floor
from opsim.whereabouts import Whereabouts

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
