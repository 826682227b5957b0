"""Paced lines: jobs come onto them in their rhythm, and they stand where something keeps them.

The clock of a line stands while the line stands, and what it is set to comes so much later.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import Floor, Source
from opsim.engine.floor.log_rows import new_row
from opsim.engine.floor.machine import (
    NOTHING,
    Array,
    Call,
    Handle,
    List,
    cast,
    drop,
    fresh,
    give_back,
    inlined,
    line_of,
    step,
    struct,
)
from opsim.engine.floor.records import Hook
from opsim.engine.floor.state import Claim, Event, Gate, Job, Station, Worker
from opsim.engine.rules import CALENDAR
from opsim.log import ABSENT, AWAY, BREAK, FULL, NO_CAUSE, OFF, STANDS, UNFINISHED
from opsim.subjects.lines.plan import LinePlan
from opsim.subjects.routes.routing import alarm, cancel, has_room, stir

AT_THE_END = 90
"""Among what is asked when an operation is done: the last, when nothing else has become of the job."""
TICK = -1
"""In place of a job's number, for what concerns the line as a whole."""


@struct
class Line:
    """Indexed, or moving. reach_m, start_s : see ``plan.LinePlan``

    move_line, stood_line : steps that move it, and that are told when it has come to stand, or to run
    act_line, stop_walks_line : of a moving line, see ``line_walks``; 0 where nobody walks along it
    changed : whether moving it changed something
    shown_s, runs_since_s, runs, pending : of its clock
    done, leaving : of an indexed line; late : jobs that are looked at just now
    n_late, n_ending : of a moving line, how many jobs are waited for, and how many at the end cannot leave
    along : by the rank of a worker, where on a moving line he is; with_job, spots, ways : those who are at a job, at
            none, and on their way to one, in the order in which they came to be so
    """

    moves: int
    move_line: Call
    stood_line: Call
    act_line: Call
    stop_walks_line: Call
    changed: int
    sends_on: int
    helps: int
    takt_s: float
    call_s: float
    speed_m_per_s: float
    exit_s: float
    n_stations: int
    stations: Array[Station]
    start_m: Array[float]
    start_s: Array[float]
    reach_m: Array[float]
    reach_s: Array[float]
    limit_s: Array[float]
    n_people: int
    people: Array[Worker]
    due: int
    open_s: float
    taken: int
    why: int
    since_s: float
    shown_s: float
    runs_since_s: float
    runs: int
    pending: List[Due]
    done: List[Job]
    leaving: int
    late: List[Job]
    n_late: int
    n_ending: int
    andon: Andon
    along: Array[Along]
    with_job: List[Along]
    spots: List[Along]
    ways: List[Along]


@struct
class Due:
    """What is to be done when the clock of a line shows a time. call_line : the step, which gets this

    rank, number : its place among the reports of that instant; job, at : what the step needs to know
    """

    line: Line
    at_s: float
    rank: int
    number: int
    call_line: Call
    job: Job
    at: int
    event: Event


@struct
class Along:
    """A worker and a moving line: the job he is at, the spot where he is, his way to a job (``line_walks``).

    has_job, job, began_s, at : the job he is at, when that came onto the line, and the how many-th station it is
    has_spot, place, from_m, to_m, since_s, strolls : see ``Spot``; version : of the spot, for who walks back to it
    has_way, way_job, way_at, way_from_m, way_since_s, downstream : see ``Way``
    """

    line: Line
    worker: Worker
    has_job: int
    job: Job
    began_s: float
    at: int
    has_spot: int
    place: int
    from_m: float
    to_m: float
    since_s: float
    strolls: int
    version: int
    has_way: int
    way_job: Job
    way_at: int
    way_from_m: float
    way_since_s: float
    downstream: int


@struct
class LineGate:
    """A gate onto a line. first : at its beginning, where one job comes in a takt; picked, lets : what it had."""

    line: Line
    gate: Gate
    first: int
    picked: Hook
    lets: Hook


@struct
class Andon:
    """Of a line. coming : by the number of a floater, the job he is on his way to

    asked : the jobs that wait when they are gone through
    """

    line: Line
    n_floaters: int
    floaters: Array[Worker]
    waiting: List[Claim]
    coming: Array[Job]
    left_s: float
    asked: List[Job]


@inlined
def clock_s(line: Line, now: float) -> float:
    """What it shows at an instant."""
    return line.shown_s + (now - line.runs_since_s) if line.runs else line.shown_s


@inlined
def job_m(line: Line, began_s: float, now: float) -> float:
    """Where a job is that came onto the line when the clock showed ``began_s``."""
    return (clock_s(line, now) - began_s) * line.speed_m_per_s


@inlined
def is_open_at(line: Line, job: Job, at: int) -> bool:
    """Whether something is left to be done of a job at the at-th station of a moving line, where it is."""
    return job.station.line is line and job.block.line_open == at + 1


@inlined
def is_open(line: Line, job: Job) -> bool:
    """Whether something is left to be done of a job at its station."""
    if line.moves:
        return is_open_at(line, job, job.station.line_at)
    return job in job.station.seated and job not in line.done


_new_due, _forget_due = fresh(Due), give_back(Due)
_as_due = cast(Due)


@step
def comes(floor: Floor, event: Event) -> None:
    """The clock shows what it was set to."""
    due: Due = _as_due(event.subject)
    drop(due.line.pending, due)
    due.event = NOTHING
    due.call_line(floor, due)
    _forget_due(floor, due)


line_of_comes = line_of(comes)


@step
def set_clock(floor: Floor, line: Line, at_s: float, rank: int, number: int, what: Call, job: Job, at: int) -> None:
    """Do something when it shows a time that is to come: the step of line ``what``."""
    due: Due = _new_due(floor)
    due.line, due.at_s, due.rank, due.number = line, at_s, rank, number
    due.call_line, due.job, due.at = what, job, at
    line.pending.append(due)
    if line.runs:
        _set(floor, line, due)


@step
def stop_clock(floor: Floor, line: Line) -> None:
    """It stands from now on."""
    line.shown_s = clock_s(line, floor.now)
    line.runs_since_s = floor.now
    line.runs = 0
    for due in line.pending:
        if due.event:
            cancel(due.event)
            due.event = NOTHING


@step
def start_clock(floor: Floor, line: Line) -> None:
    """It runs again."""
    line.runs_since_s = floor.now
    line.runs = 1
    for one in line.pending:
        _set(floor, line, one)


@inlined
def _set(floor: Floor, line: Line, due: Due) -> None:
    delay_s = due.at_s - clock_s(line, floor.now)
    due.event = alarm(floor, delay_s, CALENDAR, due.rank, due.number, line_of_comes, due)


OUTERMOST = -100
"""Among what is told of who comes in by a gate: the line first."""


@step
def watch(floor: Floor, line: Line) -> bool:
    """Stand or run, and move on where that is due; True where something changed."""
    line.changed = 0
    why = _kept(floor, line)
    if line.due and why == NO_CAUSE:
        why = line.move_line(floor, line)
    if why != line.why:
        _stand(floor, line, why)
    return line.changed == 1


@inlined
def _kept(floor: Floor, line: Line) -> int:
    """Why the line has to stand now."""
    if line.n_ending:
        return FULL
    if floor.n_down:
        for i in range(line.n_stations):
            if line.stations[i].down:
                return line.stations[i].stands_for
    if _all_gone(line):
        return AWAY
    return UNFINISHED if line.n_late else NO_CAUSE


@inlined
def _all_gone(line: Line) -> bool:
    for i in range(line.n_people):
        kind = line.people[i].kind
        if kind != BREAK and kind != OFF and kind != ABSENT:
            return False
    return line.n_people > 0


@inlined
def _stand(floor: Floor, line: Line, why: int) -> None:
    log_stand(floor, line)
    line.why, line.since_s = why, floor.now
    if line.runs and why != NO_CAUSE:
        stop_clock(floor, line)
    elif not line.runs and why == NO_CAUSE:
        start_clock(floor, line)
    line.stood_line(floor, line)


@step
def log_stand(floor: Floor, line: Line) -> bool:
    """Write why the line stood until now."""
    if line.why != NO_CAUSE and floor.now > line.since_s:
        row = new_row(floor, STANDS, line.since_s)
        row.station, row.cause = line.stations[0].rank, line.why
    return False


@step
def tick(floor: Floor, due: Due) -> None:
    """A takt is over."""
    due.line.due = 1


line_of_tick = line_of(tick)


@step
def opens(floor: Floor, line: Line) -> None:
    """A job may come onto the line in this instant; the next takt begins."""
    line.due, line.open_s, line.taken = 0, floor.now, 0
    stir(floor, line.stations[0])
    tick_s = clock_s(line, floor.now) + line.takt_s
    set_clock(floor, line, tick_s, line.stations[0].rank, TICK, line_of_tick, NOTHING, 0)


@step
def entered(floor: Floor, line: Line, job: Job) -> None:
    """A job has come onto the line."""
    line.taken = 1


@inlined
def _is_open(floor: Floor, guard: LineGate) -> bool:
    line = guard.line
    return line.open_s == floor.now and not (guard.first and line.taken)


@step
def pick(floor: Floor, guard: LineGate, gate: Gate) -> int:
    """Nobody comes in while the gate is shut; while it is open whoever could before."""
    if not gate.claims or not _is_open(floor, guard):
        return -1
    if guard.picked:
        return guard.picked.line(floor, guard.picked.subject, gate)
    return 0 if has_room(gate) else -1


@step
def lets(floor: Floor, guard: LineGate, gate: Gate, source: Source) -> bool:
    """The same for a new job of a source."""
    if not _is_open(floor, guard):
        return False
    if guard.lets:
        return guard.lets.line(floor, guard.lets.subject, gate, source) != 0
    return len(gate.claims) == 0


def paced_line(build: Any, plan: LinePlan) -> Handle:
    """A line, with what is the same in all of them."""
    line = build.arena.new("Line")
    stations = [build.stations[rank] for rank in plan.stations]
    people = [
        worker
        for worker in build.workers
        if worker.rank not in plan.floaters and any(worker.rating[rank] > 0 for rank in plan.stations)
    ]
    line.moves, line.sends_on, line.helps, line.takt_s = plan.moves, plan.sends_on, plan.helps, plan.takt_s
    line.call_s, line.speed_m_per_s, line.exit_s = plan.call_s, plan.speed_m_per_s, plan.exit_s
    line.n_stations, line.stations = len(stations), build.arena.array("Station", stations)
    line.n_people, line.people = len(people), build.arena.array("Worker", people)
    line.due, line.open_s, line.runs = 1, -1.0, 1
    for at, station in enumerate(stations):
        station.line, station.line_at = line, at
        build.seat(station)
    for gate in _gates_of(build, plan.stations[0]):
        guard(build, gate, line, first=True)
        build.hang(gate.entered, entered, line, OUTERMOST)
    build.hang(build.floor.dispatchers, watch, line)
    build.hang(build.floor.closing, log_stand, line)
    return line


def shut_but_when_it_moves(build: Any, line: Handle, rank: int) -> None:
    """A station of a line takes jobs only in the instant in which the line moves."""
    for gate in _gates_of(build, rank):
        guard(build, gate, line, first=False)


def guard(build: Any, gate: Handle, line: Handle, first: bool) -> None:
    """Stand at a gate; ``first``: one that lets one job in each time."""
    made = build.arena.new("LineGate")
    made.line, made.gate, made.first = line, gate, first
    made.picked, made.lets = gate.pick, gate.lets
    gate.pick, gate.lets = build.hook(pick, made), build.hook(lets, made)


def _gates_of(build: Any, rank: int) -> list[Handle]:
    return [gate for ranks, gate in build.gates.items() if rank in ranks]
