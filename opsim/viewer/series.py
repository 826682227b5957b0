"""What stands on the floor through the shift: queues, jobs in work and states of stations, what lies in stores."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from opsim.log import BLOCKED, DOWN, HELD, OFF, QUEUE, REPAIR, SETUP, STOCK, WORK, EventLog
from opsim.plan import Plan
from opsim.plan.station import STATION, STORE
from opsim.viewer.scene import Courses

STATION_STATES = ("starved", "work", "setup", "blocked", "waiting", "down", "repair", "closed")
"""What a station does, as a whole; further to the right in ``_BEFORE`` goes before."""
_BEFORE = ("waiting", "blocked", "closed", "setup", "work", "down", "repair")


def stations(log: EventLog, plan: Plan, low_s: float, high_s: float) -> Courses:
    """Of each station: ``queue``, jobs that wait in front; ``busy``, servers at work; ``state``."""
    of_job, of_station = log["job"] >= 0, (log["job"] < 0) & (log["worker"] < 0)
    kind = log["kind"]
    masks = {
        "queue": (kind == QUEUE) & of_job & (log["cause"] != STOCK),
        "work": (kind == WORK) & of_job,
        "setup": kind == SETUP,
        "blocked": (kind == BLOCKED) & of_job,
        "waiting": (kind == HELD) & of_job,
        "down": (kind == DOWN) & of_station,
        "repair": (kind == REPAIR) & of_station,
        "closed": (kind == OFF) & of_station,
    }
    found = []
    for rank, station in enumerate(plan.stations):
        if station.kind == STATION:
            here = {name: np.flatnonzero(mask & (log["station"] == rank)) for name, mask in masks.items()}
            at_s, counts = levels(log, here, low_s, high_s)
            busy = np.minimum(counts["work"] + counts["setup"], station.servers)
            found.append((at_s, {"queue": counts["queue"], "busy": busy, "state": _state(counts)}))
    return _courses(found, ("queue", "busy", "state"))


def _state(counts: Mapping[str, np.ndarray]) -> np.ndarray:
    """Of each moment the number of STATION_STATES that says most."""
    found = np.zeros(counts["work"].size, dtype=int)
    for name in _BEFORE:
        found[counts[name] > 0] = STATION_STATES.index(name)
    return found


def stores(log: EventLog, plan: Plan, low_s: float, high_s: float) -> Courses:
    """Of each store: ``level``, the jobs that lie there."""
    lying = (log["kind"] == QUEUE) & (log["cause"] == STOCK)
    found = []
    for rank, store in enumerate(plan.stations):
        if store.kind == STORE:
            here = {"level": np.flatnonzero(lying & (log["station"] == rank))}
            found.append(levels(log, here, low_s, high_s))
    return _courses(found, ("level",))


def levels(
    log: EventLog, rows: Mapping[str, np.ndarray], low_s: float, high_s: float
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """(times (R,), counts (R,) by name) of the rows that are open, from each of these times on; on change only."""
    edges = [np.r_[log["start_s"][some], log["end_s"][some]] for some in rows.values()]
    times_s = np.unique(np.clip(np.concatenate([[low_s], *edges]), low_s, high_s))
    times_s = times_s[times_s < high_s] if high_s > low_s else times_s[:1]
    counts = {name: _open(log, some, times_s) for name, some in rows.items()}
    table = np.array(list(counts.values()))
    changed = np.r_[True, (np.diff(table, axis=1) != 0).any(axis=0)]
    return times_s[changed], {name: column[changed] for name, column in counts.items()}


def _open(log: EventLog, rows: np.ndarray, times_s: np.ndarray) -> np.ndarray:
    """(R,) how many rows have begun and not ended at each time."""
    begun = np.searchsorted(np.sort(log["start_s"][rows]), times_s, side="right")
    return begun - np.searchsorted(np.sort(log["end_s"][rows]), times_s, side="right")


def _courses(found: list[tuple[np.ndarray, dict[str, np.ndarray]]], names: tuple[str, ...]) -> Courses:
    first = np.cumsum([0, *(at_s.size for at_s, _ in found)])
    at_s = np.concatenate([np.zeros(0), *(at_s for at_s, _ in found)])
    columns = {name: np.concatenate([np.zeros(0, int), *(own[name] for _, own in found)]) for name in names}
    return Courses(first, at_s, columns)
