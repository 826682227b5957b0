"""Lines that move: who works on one is carried along with his job, and walks back to the next.

Who does what, where and in which posture: the rows of a log as segments that tile a window for each worker.

Parts under way: on belts, on vehicles, and in the hands of those who walk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import hypot
from typing import Any, NamedTuple

import numpy as np

from opsim.ergonomics.shift.walks import carries
from opsim.history import Whereabouts, walk_rows, walks_of, whereabouts
from opsim.kpi.states import STATES, states_of_rows
from opsim.log import IDLE, PICKUP, REPAIR, SETUP, STANDS, TRANSPORT, WALK, WORK, EventLog
from opsim.plan import Plan
from opsim.subjects.lines.plan import LinePlan
from opsim.viewer.floor import Floor, Point, drawn_as
from opsim.viewer.playback import Collected, Played, Walked, played, travels_m, walked
from opsim.viewer.routes import Doing, Routes, Spots, WayList, length_m, placed, spots_of
from opsim.viewer.scene import NONE, Moves, Performed, Segments

Clock = Callable[[float], float]


class Stretch(NamedTuple):
    """A station of a moving line: how far from the line's beginning, and which way the line goes there.

    clock : how long the line has moved; began_s : by job number, when each came onto it
    """

    line: LinePlan
    start_m: float
    ahead: Point
    clock: Clock
    began_s: dict[int, float]

    def job_m(self, job: int, at_s: float) -> float:
        """How far a job is past the beginning of the stretch."""
        return (self.clock(at_s) - self.clock(self.began_s[job])) * self.line.speed_m_per_s - self.start_m


def carried_along(log: EventLog, plan: Plan, seen: Whereabouts, spots: Spots, floor: Floor) -> Spots:
    """The spots with those on moving lines where the line has come to; unchanged where there is no such line.

    The place of a station is where its stretch begins. Who walks upstream to nobody goes as far as the time is long.
    """
    stretches = dict(_stretches(log, plan, floor))
    if not stretches:
        return spots
    x, y, dx, dy = (column.copy() for column in (spots.x_m, spots.y_m, spots.dx_m, spots.dy_m))
    station, job = log["station"][seen.row], log["job"][seen.row]
    here, ahead, visit = 0.0, (0.0, 0.0), (-1, -1)
    for i in range(seen.row.size):
        if np.isnan(x[i]) or (int(seen.worker[i]), int(seen.place_from[i])) != visit:
            here, visit = 0.0, (int(seen.worker[i]), int(seen.place_from[i]))
        found = stretches.get(int(station[i])) if seen.kind[i] in (WORK, SETUP) and job[i] >= 0 else None
        gone = 0.0
        if found is not None:
            ahead = found.ahead
            here, there = (found.job_m(int(job[i]), float(at_s)) for at_s in (seen.start_s[i], seen.end_s[i]))
            gone = there - here
        elif seen.kind[i] == WALK and here > 0:
            gone = -min(here, plan.workers[visit[0]].walk_m_per_s * float(seen.end_s[i] - seen.start_s[i]))
        x[i], y[i] = x[i] + here * ahead[0], y[i] + here * ahead[1]
        dx[i], dy[i] = gone * ahead[0], gone * ahead[1]
        here += gone
    return spots._replace(x_m=x, y_m=y, dx_m=dx, dy_m=dy)


def _stretches(log: EventLog, plan: Plan, floor: Floor) -> Iterator[tuple[int, Stretch]]:
    """Of each station of a moving line, by its rank."""
    for line in plan.lines:
        if line.moves:
            clock, began_s = _clock(log, line), _began(log, line)
            points = [floor.points_m[plan.stations[rank].place] for rank in line.stations]
            for at, rank in enumerate(line.stations):
                yield rank, Stretch(line, line.start_m[at], _ahead(points, at), clock, began_s)


def _ahead(points: list[Point], at: int) -> Point:
    """The way a line goes at its at-th station: to the next one, at the last as it came."""
    first = min(at, len(points) - 2)
    if first < 0:
        return 1.0, 0.0
    x, y = points[first + 1][0] - points[first][0], points[first + 1][1] - points[first][1]
    long_m = hypot(x, y)
    return (x / long_m, y / long_m) if long_m > 0 else (1.0, 0.0)


def _clock(log: EventLog, line: LinePlan) -> Clock:
    """How long a line has moved by a time of the run."""
    rows = np.flatnonzero((log["kind"] == STANDS) & (log["station"] == line.stations[0]))
    rows = rows[np.argsort(log["start_s"][rows], kind="stable")]
    start_s, end_s = log["start_s"][rows], log["end_s"][rows]

    def moved_s(at_s: float) -> float:
        return at_s - float((np.clip(end_s, None, at_s) - np.clip(start_s, None, at_s)).sum())

    return moved_s


def _began(log: EventLog, line: LinePlan) -> dict[int, float]:
    """When each job came onto a line."""
    rows = np.flatnonzero((log["job"] >= 0) & np.isin(log["station"], line.stations))
    rows = rows[np.argsort(-log["start_s"][rows], kind="stable")]
    return dict(zip(log["job"][rows].tolist(), log["start_s"][rows].tolist()))


REPAIRS = "repair"
SHOWN_STATES = (*STATES, REPAIRS)
"""What a segment's state may be."""
SHORT_M = 0.05
"""Ways shorter than this are not walked: people stand."""


class People(NamedTuple):
    """The segments, what performs in them, how many walks stand for how many, whether tasks lead somewhere."""

    segments: Segments
    performed: Performed
    walks_drawn: int
    walks_shown: int
    tasks_lead: bool


def people(
    log: EventLog, plan: Plan, floor: Floor, routes: Routes, ways: WayList, low_s: float, high_s: float
) -> People:
    """Everybody between two times. The plan names a walking emulator; ways are added to ``ways``."""
    whole = whereabouts(log, plan)
    spots = carried_along(log, plan, whole, spots_of(log, plan, whole, floor), floor)
    inside = (np.minimum(whole.end_s, high_s) > np.maximum(whole.start_s, low_s)) & (whole.end_s > whole.start_s)
    rows = np.flatnonzero(inside)
    found = Collected()
    work = played(log, plan, low_s, high_s, found)
    walks = _walks(log, plan, whole, spots, rows, routes, floor)
    gone = walked(log, plan, walks.number, walks.long_m, found)
    performed = found.close()
    way = _ways(walks, gone, ways, whole.row.size)
    leads_m = travels_m(performed)
    leads_m[gone.performance[gone.performance >= 0]] = 0.0
    segments = _segments(log, plan, whole, spots, rows, work, walks, gone, leads_m, way, low_s, high_s)
    return People(segments, performed, gone.drawn, walks.number.size, bool(leads_m.any()))


class _Walks(NamedTuple):
    """Walks that are shown, (R,) each: row of the whereabouts, number among all walks, points and length of the way."""

    seen: np.ndarray
    number: np.ndarray
    points: list[list[tuple[float, float]]]
    long_m: np.ndarray
    yaw: list[tuple[float, float]]
    whole_s: np.ndarray


def _walks(
    log: EventLog, plan: Plan, seen: Whereabouts, spots: Spots, rows: np.ndarray, routes: Routes, floor: Floor
) -> _Walks:
    """The ways between the spots where people stood before and stand after; those that lead nowhere are left out."""
    at = {row: number for number, row in enumerate(walk_rows(log).tolist())}
    whole_s = walks_of(log, plan).whole_s
    kept, points, long, yaw = [], [], [], []
    for i in rows[seen.kind[rows] == WALK].tolist():
        start, before = _end(seen, spots, floor, i, i - 1, int(seen.place_from[i]))
        end, after = _end(seen, spots, floor, i, i + 1, int(seen.place_to[i]))
        way = routes.points_m(start, end, int(seen.place_from[i]), int(seen.place_to[i]))
        if (long_m := length_m(way)) >= SHORT_M:
            kept.append(i)
            points.append(way)
            long.append(long_m)
            yaw.append((before, after))
    rows = np.array(kept, dtype=int)
    number = np.array([at[row] for row in seen.row[rows].tolist()], dtype=int)
    return _Walks(rows, number, points, np.array(long, dtype=float), yaw, whole_s[number])


def _end(
    seen: Whereabouts, spots: Spots, floor: Floor, walk: int, beside: int, place: int
) -> tuple[tuple[float, float], float]:
    """Where a walk begins or ends, and which way one looks there: as in the row beside it, else at the place itself."""
    there = 0 <= beside < seen.row.size and seen.worker[beside] == seen.worker[walk]
    if there and seen.place_from[beside] == place and not np.isnan(spots.x_m[beside]):
        carried = beside < walk
        x, y = (
            float(column[beside]) + carried * float(moved[beside])
            for column, moved in ((spots.x_m, spots.dx_m), (spots.y_m, spots.dy_m))
        )
        return (x, y), float(spots.yaw_rad[beside])
    return floor.points_m[place], np.nan


def _ways(walks: _Walks, gone: Walked, ways: WayList, n: int) -> np.ndarray:
    """(n,) the way of each row of whereabouts, or NONE."""
    found = np.full(n, NONE)
    for i, points, own_m, yaw in zip(walks.seen.tolist(), walks.points, gone.own_m.tolist(), walks.yaw):
        found[i] = ways.add(points, own_m, yaw)
    return found


def _segments(
    log: EventLog,
    plan: Plan,
    seen: Whereabouts,
    spots: Spots,
    rows: np.ndarray,
    work: Played,
    walks: _Walks,
    gone: Walked,
    leads_m: np.ndarray,
    way: np.ndarray,
    low_s: float,
    high_s: float,
) -> Segments:
    performance, from_s, to_s = (column[seen.row] for column in (work.performance, work.from_s, work.to_s))
    performance[walks.seen] = gone.performance
    begun_s, ended_s = seen.start_s, seen.end_s
    from_s[walks.seen] = 0.0
    to_s[walks.seen] = gone.duration_s * (ended_s - begun_s)[walks.seen] / walks.whole_s
    start_s, end_s = np.maximum(begun_s, low_s), np.minimum(ended_s, high_s)
    a_second = (to_s - from_s) / np.where(ended_s > begun_s, ended_s - begun_s, 1.0)
    to_s = from_s + a_second * (end_s - begun_s)
    from_s = from_s + a_second * (start_s - begun_s)
    doing = _doing(log, seen, performance, way, leads_m)
    x, y, yaw = (np.where(np.isnan(column), 0.0, column) for column in (spots.x_m, spots.y_m, spots.yaw_rad))
    x, y, yaw = placed(doing, (x, y, yaw))
    inside_s = np.where(ended_s > begun_s, ended_s - begun_s, 1.0)
    share, left = (start_s - begun_s) / inside_s, (end_s - start_s) / inside_s
    stands = way < 0
    dx, dy = (np.where(stands, moved, 0.0) for moved in (spots.dx_m, spots.dy_m))
    first = np.searchsorted(seen.worker[rows], np.arange(len(plan.workers) + 1))
    columns: dict[str, Any] = {
        "start_s": start_s, "end_s": end_s, "state": _states(log)[seen.row],
        "station": drawn_as(plan)[log["station"][seen.row]],
        **{name: log[name][seen.row] for name in ("task", "product", "job")},
        "performance": performance, "from_s": from_s, "to_s": to_s, "x_m": x + share * dx, "y_m": y + share * dy,
        "yaw_rad": yaw, "dx_m": left * dx, "dy_m": left * dy, "way": way,
    }  # fmt: skip
    return Segments(first, **{name: column[rows] for name, column in columns.items()})


def _doing(log: EventLog, seen: Whereabouts, performance: np.ndarray, way: np.ndarray, leads_m: np.ndarray) -> Doing:
    """The rows in which people perform at a station."""
    rows = np.flatnonzero((performance >= 0) & (way < 0))
    station, job = (log[name][seen.row[rows]] for name in ("station", "job"))
    return Doing(rows, seen.worker[rows], station, job, performance[rows], leads_m[performance[rows]])


def _states(log: EventLog) -> np.ndarray:
    """(rows,) the state of the worker of each row, as a number of SHOWN_STATES."""
    found = np.zeros(len(log), dtype=int)
    rows, state = states_of_rows(log)
    found[rows] = state
    found[(log["kind"] == REPAIR) & (log["worker"] >= 0)] = SHOWN_STATES.index(REPAIRS)
    return found


def is_gone(state: np.ndarray) -> np.ndarray:
    """Whether states are those of who is not on the floor."""
    return np.isin(state, [SHOWN_STATES.index("off"), SHOWN_STATES.index("absent")])


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
