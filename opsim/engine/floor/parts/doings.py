"""Performances in which a tool is held. See ``simpy_engine.holds``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.floor.machine import Array, struct
from opsim.engine.floor.parts.records import Stream
from opsim.engine.floor.parts.state import Worker

if TYPE_CHECKING:
    from opsim.engine.floor.parts.grips import Want


@struct
class Doing:
    """See ``simpy_engine.holds.Doing``; drawn_s, drawn_start, drawn_end : what was drawn, before human effects."""

    worker: Worker
    task: int
    k: int
    left_s: float
    start_s: float
    end_s: float
    before: float
    drawn_s: float
    drawn_start: float
    drawn_end: float
    stretch_s: float
    at_work: int
    begun: int


@struct
class Holds:
    """of_workers, of_stations : streams by worker, or station, x tasks + task; start, end : shares that were drawn last

    wanted : by task, the tool that is held
    """

    of_workers: Array[Stream]
    of_stations: Array[Stream]
    start: float
    end: float
    wanted: Array[Want]
