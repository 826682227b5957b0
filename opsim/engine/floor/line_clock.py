"""The clock of a paced line: it stands while the line stands, and what it is set to comes so much later."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, Call, cast, drop, fresh, give_back, inlined, line_of, step
from opsim.engine.floor.parts.events import alarm, cancel
from opsim.engine.floor.parts.line_clocks import clock_s
from opsim.engine.floor.parts.lines import Due, Line
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.state import Floor, Job
from opsim.engine.rules import CALENDAR

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
