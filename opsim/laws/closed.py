"""The law of opening hours: a station that its calendar closes begins nothing."""

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.laws.stays import Stays, words
from opsim.log import CLOSED, DOWN, HELD, JOB_KINDS, OFF, REPAIR, SETUP, WORK, EventLog
from opsim.plan import Plan


def closed(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """Rows say that a station is closed in exactly the hours in which its calendar closes it; nothing begins then.

    What was begun before is finished where the station's rule says so, and else rests until it opens. The hours alone
    break nothing off there: only a stop of the station does, or somebody who has to go.
    """
    shut = log.where((log["kind"] == OFF) & (log["station"] >= 0) & (log["worker"] < 0))
    for rank in np.unique(shut["station"]):
        if plan.stations[rank].open_s is None:
            yield f"station {plan.stations[rank].name}: closed, though it is always open"
    for rank, place in enumerate(plan.stations):
        if place.open_s is not None:
            here = shut.where(shut["station"] == rank)
            edges = np.r_[ticks(here["start_s"]), ticks(here["end_s"])].reshape(2, -1)
            planned = closed_ticks(place.open_s, plan.horizon_s)
            if not np.array_equal(edges, planned):
                yield f"station {place.name}: rows close it for {_hours(edges)}, its calendar for {_hours(planned)}"
            if planned.size:
                yield from _at_work(log, plan, rank, planned)
                if place.at_close == "finish":
                    yield from _left_undone(log, plan, rank)


def closed_ticks(open_s, horizon_s: float) -> np.ndarray:
    """(2, N) when each time begins and ends, in ticks, that is not one of the open ones."""
    edges = ticks([0.0, *(edge for stretch in open_s for edge in stretch), horizon_s]).reshape(-1, 2).T
    return edges[:, edges[1] > edges[0]]


def _at_work(log: EventLog, plan: Plan, rank: int, shut: np.ndarray) -> Iterator[str]:
    rows = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["station"] == rank) & (log["job"] >= 0))
    rows = rows[np.lexsort([log["start_s"][rows], log["job"][rows]])]
    begins, ends = ticks(log["start_s"][rows]), ticks(log["end_s"][rows])
    within = np.searchsorted(shut[0], ends, side="left") - 1
    meets = (within >= 0) & (shut[1][within] > begins)
    if plan.stations[rank].at_close == "finish":
        goes_on = np.zeros(rows.size, dtype=bool)  # what is handed over goes on without a gap
        goes_on[1:] = (begins[1:] == ends[:-1]) & (log["job"][rows][1:] == log["job"][rows][:-1])
        goes_on |= begins == shut[0][within]  # it was gone on with in the very instant, before it closed
        goes_on &= log["progress_from"][rows] > 0
        meets &= (begins >= shut[0][within]) & ~goes_on
    for at in np.flatnonzero(meets)[:1]:
        moment = max(begins[at], shut[0][within[at]])
        yield f"station {plan.stations[rank].name}: work goes on at {words(moment)}, while it is closed"


def _left_undone(log: EventLog, plan: Plan, rank: int) -> Iterator[str]:
    """What was begun there and then waits, at once and half done, until the station opens."""
    rows = np.flatnonzero(np.isin(log["kind"], JOB_KINDS) & (log["job"] >= 0) & (log.duration_s > 0))
    rows = rows[np.lexsort([log["start_s"][rows], log["job"][rows]])]
    job, kind, here = log["job"][rows], log["kind"][rows], log["station"][rows] == rank
    begun = np.isin(kind, (WORK, SETUP)) & here & (log["progress_to"][rows] < 1.0)
    waits = (kind == HELD) & here & (log["cause"][rows] == CLOSED)
    left = np.flatnonzero(begun[:-1] & waits[1:] & (job[1:] == job[:-1]))
    moments = ticks(log["end_s"][rows[left]])
    of_stops = np.isin(log["kind"], (DOWN, REPAIR)) & (log["station"] == rank) & (log["job"] < 0) & (log["worker"] < 0)
    stopped = np.isin(moments, ticks(log["start_s"][of_stops]))
    for at in np.flatnonzero(~stopped):
        if not _somebody_had_to_go(log, plan, rank, moments[at]):
            what = f"job {job[left[at]]} is left undone at {words(moments[at])}"
            yield f"station {plan.stations[rank].name}: {what}, though what was begun is finished there"
            return


def _somebody_had_to_go(log: EventLog, plan: Plan, rank: int, moment: int) -> bool:
    """Whether a pause or the shift of somebody began or ended then who had been at work at a station."""
    rows = np.isin(log["kind"], (WORK, SETUP)) & (log["station"] == rank) & (log["worker"] >= 0)
    for worker in np.unique(log["worker"][rows & (ticks(log["end_s"]) == moment)]):
        for one in plan.workers[worker].duties or ():
            ends_s = one.end_s, one.end_s + plan.shifts[one.shift].overtime_s
            if moment in ticks([*ends_s, *(pause.start_s for pause in one.pauses)]):
                return True
    return False


def _hours(edges: np.ndarray) -> str:
    return f"{(edges[1] - edges[0]).sum() / 2**20 / 3600:g} h in {edges.shape[1]} stretches"
