"""What people with shifts know: whether they are there, all that changes in it, in order of time, and their pauses."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from opsim.clock import TICKS_PER_S
from opsim.engine import rules
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.log_rows import log_worker
from opsim.engine.floor.machine import NOTHING, Array, Call, Handle, List, inlined, step, struct
from opsim.engine.floor.records import Stream
from opsim.engine.floor.state import Claim, Job, Worker
from opsim.engine.rules import CALENDAR, INTERRUPTION_RULES
from opsim.log import BREAK, MEETING
from opsim.subjects.people.worker import be_busy, set_free, take_off, walk
from opsim.subjects.routes.routing import alarm
from opsim.subjects.shifts.plan import Duty as PlannedDuty
from opsim.subjects.shifts.plan import Pause as PlannedPause

GONE, HERE, LEAVING, PAUSED = range(4)
"""LEAVING: he will go as soon as he may; PAUSED: in a pause, on the way to its place included."""
END, BEGIN, PAUSE = range(3)
"""What changes, in the order in which changes of one instant are applied."""
CalendarMoment = tuple[float, int, PlannedDuty, PlannedPause | PlannedDuty | None]
"""(when, what, in which shift, which pause or, at the end of a shift, which shift follows at once)"""


def moments(duties: tuple[PlannedDuty, ...]) -> Iterator[CalendarMoment]:
    """All changes in order of time, on the grid; a shift that the horizon cuts has no end."""
    found: list[CalendarMoment] = []
    for duty, after in zip(duties, (*duties[1:], None)):
        found.append((_exact(duty.start_s), BEGIN, duty, None))
        for pause in duty.pauses:
            if pause.start_s < pause.end_s and duty.start_s <= pause.start_s < duty.end_s:
                found.append((_exact(pause.start_s), PAUSE, duty, pause))
        follows = after is not None and after.start_s <= duty.end_s
        found.append((_exact(duty.end_s), END, duty, after if follows else None))
    return iter(sorted(found, key=lambda moment: moment[:2]))


def _exact(time_s: float) -> float:
    """As the engine rounds delays, but that the start of the run stays what it is."""
    return round(time_s * TICKS_PER_S) / TICKS_PER_S


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


@struct
class Relief:
    """Somebody is to take over a job from a worker since a time; taker : who is on his way."""

    leaver: Worker
    job: Job
    since_s: float
    taker: Worker


@struct
class Known:
    """Whether jobs come to stations that are wanted, through those that are passed. comes : by product and step."""

    wanted: Array[int]
    passed: Array[int]
    comes: Array[int]


@struct
class Needs:
    """at_once : by station, how many workers its tasks take at most; 0 where it works alone

    n_open : by station, pairs of times at which it is open, -1: always; open_s : all pairs; first_open : by station
    first_step : by product, where its steps are in ``comes``; n_steps : of all products
    opens : by station, whether it is open before some time; n_able : how many can work there
    mine, lacking, passed : stations as bits, of the question at hand; held : of those inside each, see ``held_up``
    comes : whether jobs come there, by product and step; known : what was found before; last : room for what is not
    """

    at_once: Array[int]
    n_open: Array[int]
    first_open: Array[int]
    open_s: Array[float]
    first_step: Array[int]
    n_steps: int
    opens: Array[int]
    n_able: Array[int]
    mine: Array[int]
    lacking: Array[int]
    passed: Array[int]
    held: Array[int]
    comes: Array[int]
    last: Array[int]
    known: List[Known]


@struct
class People:
    """What ``attendance``, ``leaving``, ``ties`` and ``relief`` know.

    those : the n workers who have shifts, by rank; n_watched : of them; n_tied : jobs that wait for one worker
    left : jobs that somebody would have to carry who has gone off; left_jobs, left_since_s : when they are gone through
    asked, coming : by the rank of who wants to go, and of who is on his way; in_turn : reliefs that are gone through
    pause_over_line and the others : steps that are told; 0 where the floor has nobody who would have to be
    """

    n: int
    those: Array[Presence]
    n_watched: int
    n_tied: int
    left: List[Claim]
    left_jobs: List[Job]
    left_since_s: List[float]
    n_asked: int
    asked: Array[Relief]
    n_coming: int
    coming: Array[Relief]
    in_turn: List[Relief]
    no_relief: Relief
    needs: Needs
    pause_over_line: Call
    turns_back_line: Call
    help_over_line: Call
    disband_line: Call


def presence_of(build: Any, worker: Handle) -> Handle:
    """Of a worker who has shifts."""
    made = build.arena.new("Presence")
    made.worker, worker.presence = worker, made
    duties = build.plan.workers[worker.rank].duties
    known = {id(duty): _duty(build, duty) for duty in duties}
    found = []
    for at_s, what, duty, other in moments(duties):
        moment = build.arena.new("Moment")
        moment.at_s, moment.what, moment.duty = at_s, what, known[id(duty)]
        if isinstance(other, PlannedPause):
            moment.pause = _pause(build, other)
        elif other is not None:
            moment.follows = known[id(other)]
        found.append(moment)
    made.n_moments, made.moments = len(found), build.arena.array("Moment", found)
    return made


def _duty(build: Any, duty: PlannedDuty) -> Handle:
    shift, made = build.plan.shifts[duty.shift], build.arena.new("Duty")
    made.end_s, made.number, made.overtime_s = duty.end_s, duty.number, shift.overtime_s
    made.at_break, made.at_end = INTERRUPTION_RULES[shift.at_break], INTERRUPTION_RULES[shift.at_end]
    return made


def _pause(build: Any, pause: PlannedPause) -> Handle:
    made = build.arena.new("Pause")
    made.start_s, made.end_s, made.meeting, made.place = pause.start_s, pause.end_s, pause.meeting, pause.place
    return made


_pause_lasts_s = inlined(rules.pause_lasts_s)


@step
def begin_pause(floor: Floor, one: Presence) -> None:
    """He is free, and the first of the pauses he is owed begins: with the walk to its place, where it has one."""
    worker, pause = one.worker, one.owed.pop(0)
    one.pause = pause
    lasts_s, rank = _pause_lasts_s(pause.start_s, pause.end_s), floor.n_stations + floor.n_sources + worker.rank
    event = alarm(floor, lasts_s, CALENDAR, rank, 1, floor.people.pause_over_line, one)
    event.other = pause
    if pause.place >= 0:
        metres = floor.distance_m[worker.place * floor.n_places + pause.place]
        if metres > 0:
            log_worker(floor, worker)
            be_busy(floor, worker)
            walk(floor, worker, pause.place, metres / worker.walk_m_per_s)
            return
        worker.place = pause.place
    rest(floor, one)


@step
def rest(floor: Floor, one: Presence) -> None:
    """He is where he spends it."""
    meeting = False
    if one.pause:
        meeting = one.pause.meeting == 1
    take_off(floor, one.worker, BREAK, MEETING if meeting else 0)


@step
def end_pause(floor: Floor, one: Presence) -> None:
    """He is free again, where he stands; or as soon as he has walked to where he wanted to spend it."""
    one.pause = NOTHING
    if one.worker.kind == BREAK:
        set_free(floor, one.worker)
