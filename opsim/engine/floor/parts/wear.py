"""What counts towards the breakdowns of a station: its meter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.floor.machine import Call, List, struct
from opsim.engine.floor.parts.records import Event, Stream

if TYPE_CHECKING:
    from opsim.engine.floor.parts.failing import Stop


@struct
class Countdown:
    """Seconds until one kind of breakdown. line : of the step that is told when they are over."""

    stop: Stop
    gaps: Stream
    left_s: float
    since_s: float
    alarm: Event
    line: Call


@struct
class Cycles:
    """Operations until one kind of breakdown."""

    stop: Stop
    gaps: Stream
    left: float


@struct
class Wear:
    """begin_line, end_line, cycle_line : steps told of the begin and end of a performance, and of an operation done.

    n_at_work : performances under way
    """

    begin_line: Call
    end_line: Call
    cycle_line: Call
    clock: List[Countdown]
    busy: List[Countdown]
    cycles: List[Cycles]
    n_at_work: int
