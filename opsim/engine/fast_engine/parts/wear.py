"""What counts towards the breakdowns of a station: its meter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.fast_engine.machine import List, struct
from opsim.engine.fast_engine.parts.records import Event, Stream

if TYPE_CHECKING:
    from opsim.engine.fast_engine.parts.failing import Stop


@struct
class Countdown:
    """Seconds until one kind of breakdown. line : of the step that is told when they are over."""

    stop: Stop
    gaps: Stream
    left_s: float
    since_s: float
    alarm: Event
    line: int


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

    begin_line: int
    end_line: int
    cycle_line: int
    clock: List[Countdown]
    busy: List[Countdown]
    cycles: List[Cycles]
    n_at_work: int
