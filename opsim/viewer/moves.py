"""Parts under way: on belts, on vehicles, and in the hands of those who walk."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from opsim.ergonomics.shift.carried import carries
from opsim.log import IDLE, PICKUP, TRANSPORT, EventLog
from opsim.plan import Plan
from opsim.viewer.floor import Floor
from opsim.viewer.scene import NONE, Moves
from opsim.viewer.ways import Routes, WayList
from opsim.walks import walk_rows

ON_BELT, ON_VEHICLE, IN_HANDS = 0, 1, 2


class _Move(NamedTuple):
    start_s: float
    end_s: float
    kind: int
    worker: int
    product: int
    way: int


def moves(log: EventLog, plan: Plan, floor: Floor, routes: Routes, ways: WayList, low_s: float, high_s: float) -> Moves:
    """All parts that are under way between two times, by the time they set off; ways are added to ``ways``."""
    found = [*_on_belts(log, plan, floor, ways), *_on_vehicles(log, plan, floor, routes, ways), *_in_hands(log, plan)]
    shown = sorted(move for move in found if min(move.end_s, high_s) > max(move.start_s, low_s))
    columns = np.array(shown, dtype=float).reshape(-1, len(_Move._fields)).T
    return Moves(columns[0], columns[1], *(column.astype(int) for column in columns[2:]))


def _on_belts(log: EventLog, plan: Plan, floor: Floor, ways: WayList) -> Iterator[_Move]:
    """Each job rides from end to end; what stands there, or behind others, is drawn at the end."""
    drawn = {belt.name: belt.points_m for belt in floor.belts}
    for belt in plan.conveyors:
        points = list(drawn[plan.stations[belt.station].name])
        rides, stands = ways.add(points), ways.add([points[-1], points[-1]])
        rows = np.flatnonzero((log["station"] == belt.station) & (log["job"] >= 0) & (log["worker"] < 0))
        for row in rows[log["end_s"][rows] > log["start_s"][rows]].tolist():
            way = rides if log["kind"][row] == TRANSPORT else stands
            yield _Move(*_times(log, row), ON_BELT, NONE, int(log["product"][row]), way)


def _on_vehicles(log: EventLog, plan: Plan, floor: Floor, routes: Routes, ways: WayList) -> Iterator[_Move]:
    """Each vehicle all the time: where it drives, and where it stands between; with what it carries, where it does."""
    rows = np.flatnonzero((log["kind"] == TRANSPORT) & (log["job"] < 0) & (log["k"] >= 0))
    jobs = np.flatnonzero((log["kind"] == TRANSPORT) & (log["job"] >= 0) & (log["worker"] < 0))
    first, drawn = 0, dict[tuple[int, int], int]()
    for pool in plan.transporters:
        for number in range(first, first + pool.n):
            place, at_s = pool.place, 0.0
            own = rows[log["k"][rows] == number]
            for row in [*own[np.argsort(log["start_s"][own], kind="stable")].tolist(), None]:
                start_s, end_s = (log.horizon_s, log.horizon_s) if row is None else _times(log, row)
                if start_s > at_s:
                    yield _Move(at_s, start_s, ON_VEHICLE, NONE, NONE, _way(drawn, place, place, floor, routes, ways))
                if row is None:
                    break
                goal = int(log["place_to"][row])
                way = _way(drawn, int(log["place_from"][row]), goal, floor, routes, ways)
                yield _Move(start_s, end_s, ON_VEHICLE, NONE, _aboard(log, row, jobs), way)
                place, at_s = goal, end_s
        first += pool.n


def _aboard(log: EventLog, row: int, jobs: np.ndarray) -> int:
    """The product of a job that is on its way all the while and gets off in the end; NONE for an empty vehicle."""
    if log["cause"][row] in (PICKUP, IDLE):
        return NONE
    start_s, end_s = _times(log, row)
    there = jobs[(log["start_s"][jobs] <= start_s) & (log["end_s"][jobs] >= end_s)]
    return int(log["product"][there[0]]) if there.size else NONE


def _way(drawn: dict[tuple[int, int], int], start: int, end: int, floor: Floor, routes: Routes, ways: WayList) -> int:
    if (start, end) not in drawn:
        ends = floor.points_m[start], floor.points_m[end]
        drawn[start, end] = ways.add(routes.points_m(*ends, start, end))
    return drawn[start, end]


def _in_hands(log: EventLog, plan: Plan) -> Iterator[_Move]:
    rows = walk_rows(log)
    for row in rows[carries(log, plan, rows)].tolist():
        yield _Move(*_times(log, row), IN_HANDS, int(log["worker"][row]), int(log["product"][row]), NONE)


def _times(log: EventLog, row: int) -> tuple[float, float]:
    return float(log["start_s"][row]), float(log["end_s"][row])
