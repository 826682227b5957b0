"""The law of rooms: nothing stands where there is no place for it.

The law of what is shared: no more tools, cards, repair teams or vehicles are in use than there are.

The law of outages: a station that is down does nothing, and is down for one reason at a time.

The law of jobs that wait for one worker: he is away, or on his way, as long as they wait for him.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.laws.jobs import Stays, peak, words
from opsim.log import (
    AFTER,
    AWAY,
    BLOCKED,
    DOWN,
    HELD,
    PICKUP,
    QUEUE,
    REPAIR,
    SETUP,
    TOOL,
    TRANSPORT,
    WAIT,
    WORK,
    EventLog,
)
from opsim.plan import Plan
from opsim.plan.compile import has_card
from opsim.plan.stations import STATION
from opsim.plan.stores import CardPlan, jobs_on_a_server

ON_SERVER = (WORK, SETUP, BLOCKED, HELD)


def rooms(_log: EventLog, plan: Plan, stays: Stays) -> Iterator[str]:
    """No more jobs at a point than fit there, on its servers, in its buffers, and with those on their way to it.

    A job that comes back to its own station may wait in its buffer although others keep the server that they shared.
    """
    for rank, place in enumerate(plan.stations):
        here = stays.rows.where(stays.rows["station"] == rank)
        queued = here["kind"] == QUEUE
        done = queued & np.isin(here["cause"], (AFTER, PICKUP))
        together = jobs_on_a_server(plan, rank) if place.kind == STATION else 1
        servers = place.servers * together
        rules = []
        if place.kind == STATION:
            rules = [
                (np.isin(here["kind"], ON_SERVER), servers, "servers"),
                (queued & ~done & (together == 1), place.buffer, "places in its buffer"),
                (done, place.buffer_after, "places in the buffer after it"),
            ]
        for mask, most, what in [*rules, (~done, servers + place.buffer, "places")]:
            found = peak(here.where(mask))
            if found > most:
                yield f"{place.kind} {place.name}: {found} jobs at once on {most:g} {what}"


def shared(log: EventLog, plan: Plan, stays: Stays) -> Iterator[str]:
    """Everything that several ask for and only so many can have."""
    yield from tools_in_use(log, plan)
    yield from repair_teams_in_use(log, plan)
    yield from vehicles_in_use(log, plan)
    yield from cards_in_use(plan, stays)


def cards_in_use(plan: Plan, stays: Stays) -> Iterator[str]:
    """No more jobs are in a loop than it has cards."""
    for card in plan.cards:
        found = _most_cards(stays.rows, plan, card)
        if found > card.n:
            yield f"loop {card.name}: {found} jobs in it at once on {card.n} cards"


def tools_in_use(log: EventLog, plan: Plan) -> Iterator[str]:
    if not plan.tools:
        return
    held = log.of(TOOL)
    for rank, tool in enumerate(plan.tools):
        found = peak(held.where(held["k"] == rank))
        if found > tool.n:
            yield f"tool {tool.name}: {found} in use at once of {tool.n}"


def repair_teams_in_use(log: EventLog, plan: Plan) -> Iterator[str]:
    if not plan.repair_teams:
        return
    repairs = log.of(REPAIR)
    for rank, team in enumerate(plan.repair_teams):
        tasks = [stop.task for stops in (plan.breakdowns, plan.maintenance) for stop in stops if stop.team == rank]
        found = peak(repairs.where(np.isin(repairs["task"], tasks)))
        if found > team.n:
            yield f"repair team {team.name}: at {found} stops at once, and can see to {team.n}"


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


def _most_cards(rows: EventLog, plan: Plan, card: CardPlan) -> int:
    """The most jobs at once that were seen to have a card: from a point where one is taken until they left its end."""
    wanted = [rank for rank, steps in enumerate(card.steps) if steps]
    here = np.flatnonzero(np.isin(rows["product"], wanted) & (rows["station"] >= 0))
    here = here[np.argsort(rows["job"][here], kind="stable")]
    firsts = np.flatnonzero(np.diff(rows["job"][here], prepend=-1))
    has = np.zeros(here.size, dtype=bool)
    for first, last in zip(firsts, [*firsts[1:], here.size]):
        product = int(rows["product"][here[first]])
        has[first:last] = has_card(card, product, plan, rows["station"][here[first:last]].tolist())
    return peak(rows.where(here[has]))


def one_outage_at_a_time(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """Rows of a station's outages do not overlap, and no performance or set-up there overlaps with one of them."""
    down = log.where(np.isin(log["kind"], (DOWN, REPAIR)) & (log["job"] < 0) & (log["worker"] < 0))
    if not len(down):
        return
    at_work = log.where(np.isin(log["kind"], (WORK, SETUP)) & (log["station"] >= 0))
    for rank in np.unique(down["station"]):
        name = plan.stations[rank].name
        start, end = _sorted(down.where(down["station"] == rank))
        twice = np.flatnonzero(start[1:] < end[:-1])
        if twice.size:
            yield f"station {name}: goes down at {words(start[twice[0] + 1])}, while it is down already"
        begins, ends = _sorted(at_work.where(at_work["station"] == rank))
        before = np.searchsorted(start, ends, side="left") - 1  # the last outage that began before the work ended
        meets = np.flatnonzero((before >= 0) & (end[before] > begins))
        if meets.size:
            outage = before[meets[0]]
            yield f"station {name}: work goes on at {words(max(start[outage], begins[meets[0]]))}, while it is down"


def _sorted(rows: EventLog) -> tuple[np.ndarray, np.ndarray]:
    """(rows,) starts and ends in ticks, by start."""
    order = np.argsort(rows["start_s"], kind="stable")
    return ticks(rows["start_s"][order]), ticks(rows["end_s"][order])


def away(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """A job waits for its worker only where its last piece was his and left something, and until he is there again.

    Where he is back and its station stands, or its tools are gone, it waits for these, and is anybody's then.
    """
    rows = np.flatnonzero((log["kind"] == HELD) & (log["cause"] == AWAY) & (log["job"] >= 0))
    if not rows.size:
        return
    work = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0))
    last = _last_piece(log, work[log["job"][work] >= 0], rows)
    for row in rows[(last < 0) | (log["progress_to"][last] == 1.0)][:1]:
        yield f"job {log['job'][row]}: waits for a worker at {log['start_s'][row]:g} s, and none has left work on it"
        return
    there = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP, WAIT)))
    for worker in np.unique(log["worker"][last]):
        own = there[log["worker"][there] == worker]
        own = own[np.argsort(log["start_s"][own], kind="stable")]
        waits = rows[log["worker"][last] == worker]
        first = np.searchsorted(ticks(log["end_s"][own]), ticks(log["start_s"][waits]), side="right")
        begins = np.r_[ticks(log["start_s"][own]), np.iinfo(np.int64).max][first]
        for at in np.flatnonzero(begins < ticks(log["end_s"][waits]))[:1]:
            of, moment = f"job {log['job'][waits[at]]}", words(max(begins[at], ticks(log["start_s"][waits[at]])))
            does = "is there, and idle," if log["kind"][own[first[at]]] == WAIT else "is at work elsewhere"
            yield f"{of}: waits for {plan.workers[worker].name}, who {does} at {moment}"


def _last_piece(log: EventLog, work: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(rows,) the last piece of each row's job that was over when the row began; -1 where there is none."""
    order = work[np.lexsort([log["end_s"][work], log["job"][work]])]
    keys = np.rec.fromarrays([log["job"][order], ticks(log["end_s"][order])])
    asked = np.rec.fromarrays([log["job"][rows], ticks(log["start_s"][rows])])
    at = np.searchsorted(keys, asked, side="right") - 1
    found = np.r_[order, -1][at]  # at is -1 where there is none
    return np.where((found >= 0) & (log["job"][found] == log["job"][rows]), found, -1)
