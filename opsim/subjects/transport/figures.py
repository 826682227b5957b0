"""What transporters do, how far they drive, and how long jobs wait for them. What rides on conveyors.

The law of vehicles: each does one thing at a time, and there are no others.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import any_s, in_window, inside_s, mean, window_length_s
from opsim.laws.jobs import peak
from opsim.log import BLOCKED, HELD, IDLE, JOB_KINDS, PICKUP, QUEUE, TRANSPORT, EventLog
from opsim.plan import Plan
from opsim.subjects.stations.plan import CONVEYOR


def transporters(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each transporter, over the window and all its vehicles:

    transporter_states : shares of time that sum to 1: loaded (driving with jobs), empty (driving without), handling
                         (loading or unloading), free
    driven_m           : metres of all its vehicles together, by the time that a drive has in the window
    pickup_wait_s      : from when a job could go until it was loaded, mean of those loaded in the window that waited
    """
    first, length_s = 0, window_length_s(plan)
    for pool in plan.transporters:
        rows = _rows(log, first, pool.n)
        first += pool.n
        spent_s, stands = inside_s(log, rows, plan), log["place_from"][rows] == log["place_to"][rows]
        empty = np.isin(log["cause"][rows], (PICKUP, IDLE))
        states = {
            "loaded": spent_s[~empty & ~stands].sum(),
            "empty": spent_s[empty].sum(),
            "handling": spent_s[~empty & stands].sum(),
        }
        states["free"] = pool.n * length_s - sum(states.values())
        for part, seconds in states.items():
            yield figure("transporter_states", pool.name, part, seconds / (pool.n * length_s))
        yield figure("driven_m", pool.name, "", spent_s[~stands].sum() * pool.speed_m_per_s)
        waits_s = _waits_s(log, plan, {(leg.before, leg.after) for leg in pool.legs})
        if waits_s.size:
            yield figure("pickup_wait_s", pool.name, "", mean(waits_s))


def _rows(log: EventLog, first: int, n: int) -> np.ndarray:
    """The rows of n vehicles, from the number of the first."""
    vehicles = (log["kind"] == TRANSPORT) & (log["job"] < 0)
    return np.flatnonzero(vehicles & (log["k"] >= first) & (log["k"] < first + n))


def _waits_s(log: EventLog, plan: Plan, legs: set[tuple[int, int]]) -> np.ndarray:
    """Seconds of each job that waited for a vehicle of some legs, and was loaded in the window."""
    loaded = np.flatnonzero((log["job"] >= 0) & (log["kind"] == TRANSPORT))
    goal = {(log["job"][row], log["start_s"][row]): log["station"][row] for row in loaded}
    asked = np.isin(log["kind"], (HELD, QUEUE)) & (log["cause"] == PICKUP) & in_window(log["end_s"], plan)
    waited = [row for row in np.flatnonzero(asked) if (log["job"][row], log["end_s"][row]) in goal]
    mine = [row for row in waited if (log["station"][row], goal[log["job"][row], log["end_s"][row]]) in legs]
    return log["end_s"][mine] - log["start_s"][mine]


def conveyors(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each conveyor: on_conveyor, jobs on it, averaged over the window; conveyor_blocked, the share of the window in
    which the job at its end finds no room.
    """
    for rank, belt in enumerate(plan.stations):
        if belt.kind != CONVEYOR:
            continue
        here = np.flatnonzero((log["station"] == rank) & (log["job"] >= 0) & np.isin(log["kind"], JOB_KINDS))
        blocked = here[log["kind"][here] == BLOCKED]
        length_s = window_length_s(plan)
        yield figure("on_conveyor", belt.name, "", inside_s(log, here, plan).sum() / length_s)
        yield figure("conveyor_blocked", belt.name, "", any_s(log, plan, blocked) / length_s)


def vehicles_in_use(log: EventLog, plan: Plan) -> Iterator[str]:
    """A vehicle does one thing at a time, and there are no others."""
    if not plan.transporters:
        return
    rows = log.where((log["kind"] == TRANSPORT) & (log["job"] < 0) & (log["worker"] < 0))
    n = sum(pool.n for pool in plan.transporters)
    if len(rows) and not 0 <= rows["k"].min() <= rows["k"].max() < n:
        yield f"vehicle {rows['k'].max()} drives, and there are {n}"
    for vehicle in np.unique(rows["k"]):
        if peak(rows.where(rows["k"] == vehicle)) > 1:
            yield f"vehicle {vehicle} does two things at once"
