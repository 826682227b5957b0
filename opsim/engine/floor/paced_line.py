"""A paced line: jobs come onto it in its rhythm, and it stands where something keeps it."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.line_clock import set_clock, start_clock, stop_clock
from opsim.engine.floor.machine import NOTHING, Handle, inlined, line_of, step
from opsim.engine.floor.parts.events import stir
from opsim.engine.floor.parts.gates import has_room
from opsim.engine.floor.parts.line_clocks import clock_s
from opsim.engine.floor.parts.lines import TICK, Due, Line, LineGate
from opsim.engine.floor.parts.records import Source
from opsim.engine.floor.parts.rows import new_row
from opsim.engine.floor.parts.state import Floor, Gate, Job
from opsim.log import ABSENT, AWAY, BREAK, FULL, NO_CAUSE, OFF, STANDS, UNFINISHED
from opsim.plan import LinePlan

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
