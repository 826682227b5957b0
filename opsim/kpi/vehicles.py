"""What transporters do, how far they drive, and how long jobs wait for them."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import in_window, inside_s, mean, window_length_s
from opsim.log import HELD, IDLE, PICKUP, QUEUE, TRANSPORT, EventLog
from opsim.plan import Plan


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
            yield Figure("transporter_states", pool.name, part, "share", seconds / (pool.n * length_s))
        yield Figure("driven_m", pool.name, "", "m", spent_s[~stands].sum() * pool.speed_m_per_s)
        waits_s = _waits_s(log, plan, {(leg.before, leg.after) for leg in pool.legs})
        if waits_s.size:
            yield Figure("pickup_wait_s", pool.name, "", "s", mean(waits_s))


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
