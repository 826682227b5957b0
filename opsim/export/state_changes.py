"""What workers and stations are doing, as changes over time."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from opsim import log as kinds
from opsim.log import KINDS, WORKER_KINDS, EventLog
from opsim.plan import Plan
from opsim.plan.station import STATION

Changes = list[tuple[float, str]]
"""(from when on, state) in order of time; the first from 0 s."""

_WORKER_WORDS = {kinds.OFF: "off duty", kinds.SETUP: "set up"}
_ORDER = ("work", "set up", "closed", "repair", "down", "blocked", "waiting")
"""States of a station, the one that counts first: finished work is work after closing time too."""
_STATE = {
    kinds.WORK: "work",
    kinds.SETUP: "set up",
    kinds.OFF: "closed",
    kinds.REPAIR: "repair",
    kinds.DOWN: "down",
    kinds.BLOCKED: "blocked",
    kinds.HELD: "waiting",
}
STARVED = "starved"


def worker_changes(log: EventLog, plan: Plan) -> Iterator[Changes]:
    """Of each worker, from his rows: work, set up, repair, walk, wait, break, off duty, absent."""
    rows = np.flatnonzero(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    rows = rows[np.lexsort([log["end_s"][rows], log["start_s"][rows], log["worker"][rows]])]
    firsts = np.searchsorted(log["worker"][rows], np.arange(len(plan.workers) + 1))
    words = [_WORKER_WORDS.get(kind, name) for kind, name in enumerate(KINDS)]
    for first, last in pairwise(firsts.tolist()):
        own = rows[first:last]
        kind = log["kind"][own]
        begins = np.flatnonzero(np.diff(kind, prepend=-1))
        yield [(at_s, words[doing]) for at_s, doing in zip(log["start_s"][own][begins].tolist(), kind[begins].tolist())]


def station_changes(log: EventLog, plan: Plan) -> Iterator[Changes]:
    """Of each point of the flow: what the best of its servers does, work before blocked before waiting before starved.

    waiting : a job on a server waits, for a worker, parts, tools; nothing is said of stores and conveyors
    """
    of_job = (log["job"] >= 0) & np.isin(log["kind"], (kinds.WORK, kinds.SETUP, kinds.BLOCKED, kinds.HELD))
    of_station = (log["job"] < 0) & (log["worker"] < 0) & np.isin(log["kind"], kinds.STATION_KINDS)
    rows = np.flatnonzero((log["station"] >= 0) & (of_job | of_station))
    rows = rows[np.argsort(log["station"][rows], kind="stable")]
    firsts = np.searchsorted(log["station"][rows], np.arange(len(plan.stations) + 1))
    for point, (first, last) in zip(plan.stations, pairwise(firsts.tolist())):
        yield _swept(log, rows[first:last]) if point.kind == STATION else []


def _swept(log: EventLog, rows: np.ndarray) -> Changes:
    """The first state of ``_ORDER`` that holds, instant by instant."""
    times_s = np.unique(np.concatenate([[0.0], log["start_s"][rows], log["end_s"][rows]]))
    times_s = times_s[times_s < log.horizon_s]
    holds = np.zeros((len(_ORDER), times_s.size + 1), dtype=np.int64)
    for kind, word in _STATE.items():
        here = rows[log["kind"][rows] == kind]
        state = _ORDER.index(word)
        np.add.at(holds[state], np.searchsorted(times_s, log["start_s"][here]), 1)
        np.add.at(holds[state], np.searchsorted(times_s, log["end_s"][here]), -1)
    on = np.vstack([np.cumsum(holds, axis=1)[:, :-1] > 0, np.ones((1, times_s.size), dtype=bool)])
    state = np.argmax(on, axis=0)
    begins = np.flatnonzero(np.diff(state, prepend=-1))
    words = (*_ORDER, STARVED)
    return [(at_s, words[which]) for at_s, which in zip(times_s[begins].tolist(), state[begins].tolist())]
