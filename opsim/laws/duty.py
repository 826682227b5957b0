"""The law of duty: people work in their shifts, and after them only for as long as a rule keeps them."""

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.laws.pauses import pauses
from opsim.laws.staying import overrun
from opsim.laws.stays import Stays, words
from opsim.log import ABSENT, BREAK, OFF, REST, WORKER_KINDS, EventLog
from opsim.plan import Duty, Plan


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
