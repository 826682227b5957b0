"""The law of opening hours: a station that its calendar closes begins nothing.

What somebody may still do when his time has come: what the rule of interruption lets him finish, and no more.

The law of pauses: who is there has each break and meeting of his shift, as soon as he is done, and in full.

The law of duty: people work in their shifts, and after them only for as long as a rule keeps them.

The law of jobs that wait for one worker: he is away, or on his way, as long as they wait for him.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.laws.jobs import Stays, words
from opsim.log import (
    ABSENT,
    AWAY,
    BREAK,
    CLOSED,
    DOWN,
    HELD,
    IDLE,
    JOB_KINDS,
    OFF,
    REPAIR,
    REST,
    SETUP,
    WAIT,
    WALK,
    WORK,
    WORKER_KINDS,
    EventLog,
)
from opsim.plan import Plan
from opsim.subjects.shifts.plan import Duty, Pause


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


AT_ONCE = ("resume", "resume_any", "restart")
"""Rules under which a task is left when the time has come."""


def overrun(own: EventLog, plan: Plan, limit: int, of_shift: str) -> int | None:
    """When somebody is first at work after ``limit`` on something that no rule keeps him for; None: never. In ticks.

    own : his rows from his last work before the limit on, in order
    of_shift : the rule of his shift, which holds where the task that the limit met has none
    """
    works = np.isin(own["kind"], (WORK, SETUP))
    ends = ticks(own["end_s"])
    stands_by = np.isin(own["kind"], (WAIT, WALK)) & (own["station"] >= 0)  # or comes to it
    stands_by &= (ticks(own["start_s"]) <= limit) & (ends >= limit)
    at_limit = np.flatnonzero((works & (ends == limit)) | stands_by)[-1:]  # at work, or with the others of a team
    before = np.flatnonzero(works & (ends <= limit))[-1:]
    performance = max(own["performance_id"][before], default=-1)  # perhaps he waits for a tool in the middle of it
    met = before[(ends[before] == limit) & (own["progress_to"][before] < 1.0)]  # help came at that very instant
    rule, helped = "", (own["task"][met[0]], own["k"][met[0]]) if met.size else (-1, -1)
    job, station = (max(own[name][at_limit], default=-1) for name in ("job", "station"))
    for at in np.flatnonzero(works & (ends > limit)):
        begin = int(ticks(own["start_s"][at]))
        if begin < limit:
            performance, job, station = (own[name][at] for name in ("performance_id", "job", "station"))
            helped = own["task"][at], own["k"][at]  # who is helped goes on with the same at another pace
        rule = rule or plan.tasks[own["task"][at]].interruption or of_shift  # that of the task which the limit met
        same = own["performance_id"][at] == performance or (own["task"][at], own["k"][at]) == helped
        of_team = -1 in (job, own["job"][at])  # rows of a team's members name no job
        same_job = own["station"][at] == station and (of_team or own["job"][at] == job)
        goes_on = begin == limit and own["progress_from"][at] > 0  # what somebody began before
        same = same or (rule == "finish_job" and (same_job or goes_on))
        waited = begin > limit and stands_by.any() and own["progress_from"][at] > 0  # for a tool, in the middle of it
        same = same or (waited and own["job"][at] == job >= 0)
        if goes_on and rule == "finish_job":
            job, station = own["job"][at], own["station"][at]
        if rule in AT_ONCE or not same:
            return max(limit, begin)
    return None


def pauses(own: EventLog, plan: Plan, one: Duty) -> Iterator[str]:
    """What is missing of the pauses of a shift that he has come to. ``own`` : his rows of it, in order.

    A pause begins when it is planned, or when the one before is over, or when he is done with what the rule of
    interruption lets him finish; the way to its place is part of it. It ends when it has lasted as long as planned, or
    with the shift. What has not begun by then is lost.
    """
    begins, ends = ticks(own["start_s"]), ticks(own["end_s"])
    worked = np.flatnonzero(np.isin(own["kind"], (WORK, SETUP)))
    until, over = int(ticks(one.end_s)), 0
    for pause in _to_have(one):
        due = max(int(ticks(pause.start_s)), over)
        met, at = np.searchsorted(ends, [due, due + 1])
        while at < len(own) and begins[at] < until and not (begins[at] >= due and _sets_out(own, at, pause)):
            if _idles(own, at, begins[at] >= due):
                yield f"{pause.name} is due at {words(due)}, and he is free at {words(max(begins[at], due))}"
                return
            at += 1
        met = max(worked[: np.searchsorted(worked, met)][-1:], default=met)
        works = overrun(own.where(np.arange(met, at)), plan, due, plan.shifts[one.shift].at_break)
        if works is not None and works < until:
            yield f"{pause.name} is due at {words(due)}, and he is still at work at {words(works)}"
            return
        if at == len(own) or begins[at] >= until:
            return
        over = int(begins[at] + ticks(pause.end_s - pause.start_s))
        rests = at + (own["kind"][at] == WALK and ends[at] < min(over, until))
        if not _is_had(own, rests, ends, over, until):
            yield f"{pause.name} lasts from {words(begins[at])} to {words(ends[at])}, planned is until {words(over)}"
            return


def _to_have(one: Duty) -> Iterator[Pause]:
    """Those that begin within the shift."""
    return (pause for pause in one.pauses if one.start_s <= pause.start_s < min(pause.end_s, one.end_s))


def _sets_out(own: EventLog, at: int, pause: Pause) -> bool:
    """Whether a row is the beginning of a pause: a rest, or the walk to where it is spent."""
    kind = own["kind"][at]
    if kind == BREAK:
        return bool(own["cause"][at] != REST)  # a rest by need is none of them
    return bool(kind == WALK and _goes_nowhere(own, at) and own["place_to"][at] == pause.place >= 0)


def _idles(own: EventLog, at: int, begun: bool) -> bool:
    """Whether he stands about, or has just set out to where nobody sent him."""
    if own["kind"][at] == WAIT:
        return bool(own["cause"][at] == IDLE)
    return bool(begun and own["kind"][at] == WALK and _goes_nowhere(own, at))


def _goes_nowhere(own: EventLog, at: int) -> bool:
    return bool(own["station"][at] < 0 and own["job"][at] < 0)


def _is_had(own: EventLog, at: int, ends: np.ndarray, over: int, until: int) -> bool:
    """Whether a row is a pause up to its end, or to that of the shift or of the run; or a way that is as long."""
    if at == len(own):
        return True
    if own["kind"][at] == WALK:
        return bool(ends[at] >= min(over, until))
    return bool(own["kind"][at] == BREAK and (ends[at] in (over, until) or ends[at] == ticks(own.horizon_s)))


def duty(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """Nobody is off in his shift or there outside of it, but for what he stays for; a missed shift is missed whole, but
    for what he finishes in it where it has followed at once.

    Who has come to a shift has all its breaks and meetings (``pauses``), and no longer than they are planned.
    """
    on_shifts = [rank for rank, worker in enumerate(plan.workers) if worker.duties is not None]
    rows = np.flatnonzero(np.isin(log["kind"], WORKER_KINDS) & np.isin(log["worker"], on_shifts))
    rows = rows[np.lexsort([log["start_s"][rows], log["worker"][rows]])]
    for rank in on_shifts:
        own = log.where(rows[log["worker"][rows] == rank])
        for found in _of_worker(own, plan, plan.workers[rank].duties or ()):
            yield f"worker {plan.workers[rank].name}: {found}"


def _of_worker(own: EventLog, plan: Plan, duties: tuple[Duty, ...]) -> Iterator[str]:
    begins, ends = ticks(own["start_s"]), ticks(own["end_s"])
    from_, to = (ticks([getattr(one, edge) for one in duties]) for edge in ("start_s", "end_s"))
    kind = own["kind"]
    for at in np.flatnonzero((kind == OFF) & (_inside(begins, ends, from_, to) > 0))[:1]:
        yield f"off at {words(begins[at])}, in his shift"
    absences = [(int(b), int(e)) for b, e in zip(begins[kind == ABSENT], ends[kind == ABSENT])]
    missed = {int(end) for _, end in absences}
    whole = dict(zip(to.tolist(), from_.tolist()))
    for begin, end in absences:
        first = whole.get(end, end)
        if begin < first or begin >= end or (begin > first and first not in whole):
            yield f"absent from {words(begin)} to {words(end)}, which is no shift of his"
            return
    yield from _outside(own, begins, ends, from_, to)
    until = np.r_[from_[1:], ticks(own.horizon_s)]
    over = np.r_[to[1:], 0]
    for one, begin, end, next_begin, next_end in zip(duties, from_, to, until, over):
        if int(end) not in missed:
            after = own.where(np.arange(*np.searchsorted(begins, (begin, next_begin))))
            yield from _rested(after, one)
            there = own.where(np.arange(np.searchsorted(ends, begin, "right"), np.searchsorted(begins, next_begin)))
            yield from pauses(there, plan, one)
            if next_begin == end and int(next_end) in missed:
                after = own.where(np.arange(*np.searchsorted(begins, (begin, next_end))))
                yield from _too_long(after, plan, one, int(end))
            elif not one.cut and (limit := ticks(one.end_s + plan.shifts[one.shift].overtime_s)) < next_begin:
                yield from _too_long(after, plan, one, int(limit))


def _inside(begins: np.ndarray, ends: np.ndarray, from_: np.ndarray, to: np.ndarray) -> np.ndarray:
    """(rows,) ticks of each row that lie in some shift."""
    overlap = np.minimum(ends[:, None], to) - np.maximum(begins[:, None], from_)
    return np.maximum(overlap, 0).sum(axis=1)


def _outside(own: EventLog, begins: np.ndarray, ends: np.ndarray, from_: np.ndarray, to: np.ndarray) -> Iterator[str]:
    """Who is there outside of his shifts has stayed on after one of them."""
    there = ~np.isin(own["kind"], (OFF, ABSENT))
    comes = there & ~np.r_[False, there[:-1]]
    in_shift = np.any((begins[:, None] >= from_) & (begins[:, None] < to), axis=1)
    for at in np.flatnonzero(comes & ~in_shift)[:1]:
        yield f"comes at {words(begins[at])}, outside of his shifts"


def _rested(own: EventLog, one: Duty) -> Iterator[str]:
    rested = ticks(own.duration_s[(own["kind"] == BREAK) & (own["cause"] != REST)]).sum()
    planned = sum(int(ticks(pause.end_s - pause.start_s)) for pause in one.pauses)
    if rested > planned:
        yield f"breaks of {words(rested)} in the shift from {one.start_s:g} s, planned are {words(planned)}"


def _too_long(own: EventLog, plan: Plan, one: Duty, limit: int) -> Iterator[str]:
    """Of what he works after a shift and its overtime: no more than the rule of interruption lets him finish."""
    works = overrun(own, plan, limit, plan.shifts[one.shift].at_end)
    if works is not None:
        yield f"still at work at {words(works)}, though his shift and its overtime are over"


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
