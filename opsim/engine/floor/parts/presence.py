"""What people with shifts know of themselves: what their calendars hold, and which of it they are in."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, List, struct
from opsim.engine.floor.parts.records import Stream
from opsim.engine.floor.parts.state import Worker


@struct
class Pause:
    """A break or a meeting. place : -1 where the worker stands."""

    start_s: float
    end_s: float
    meeting: int
    place: int


@struct
class Duty:
    """One shift of one worker. at_break, at_end : numbers of rules of interruption; overtime_s : at most after it."""

    end_s: float
    number: int
    at_break: int
    at_end: int
    overtime_s: float


@struct
class Moment:
    """When what changes, in which shift; which pause it is, or which shift follows at once on its end."""

    at_s: float
    what: int
    duty: Duty
    pause: Pause
    follows: Duty


@struct
class Presence:
    """worker : who; to_come : what his calendar still holds, in order; due : the next of it

    state  : gone, here, leaving (he will go as soon as he may), or in a pause, on the way to its place included
    duty   : the shift he is on, or stays on after; None: he has none now
    goes   : whether he is leaving because his shift is over, not for a pause
    misses : whether he is absent from the shift that has followed at once on the one he is leaving
    owed   : pauses that have begun and that he has not had; pause : the one he is in
    overtime : whether he stays on after his shift; undecided : whether that is still to be seen, in this instant

    next : number of the moment that is due; watched : see ``Attendance``.
    """

    worker: Worker
    n_moments: int
    moments: Array[Moment]
    next: int
    state: int
    duty: Duty
    goes: int
    misses: int
    owed: List[Pause]
    pause: Pause
    overtime: int
    undecided: int
    watched: int
    chances: Stream
