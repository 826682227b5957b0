"""Who does what, where and in which posture: the rows of a log as segments that tile a window for each worker."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from opsim.kpi.states import STATES, states_of_rows
from opsim.log import REPAIR, WALK, EventLog
from opsim.plan import Plan
from opsim.viewer.floor import Floor, drawn_as
from opsim.viewer.lines import carried_along
from opsim.viewer.played import Collected, Played, played, travels_m
from opsim.viewer.scene import NONE, Performed, Segments
from opsim.viewer.travels import Doing, placed
from opsim.viewer.visits import Spots, spots_of
from opsim.viewer.walked import Walked, walked
from opsim.viewer.ways import Routes, WayList, length_m
from opsim.walks import walk_rows, walks_of
from opsim.whereabouts import Whereabouts, whereabouts

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
