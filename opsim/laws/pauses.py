"""The law of pauses: who is there has each break and meeting of his shift, as soon as he is done, and in full."""

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.laws.staying import overrun
from opsim.laws.stays import words
from opsim.log import BREAK, IDLE, REST, SETUP, WAIT, WALK, WORK, EventLog
from opsim.plan import Duty, Pause, Plan


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
