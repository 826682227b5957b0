"""Performances in which a tool is held. See ``holds``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.floor.machine import Array, struct
from opsim.engine.floor.parts.records import Stream
from opsim.engine.floor.parts.state import Worker

if TYPE_CHECKING:
    from opsim.engine.floor.parts.grips import Want


@struct
class Doing:
    """A performance with a hold, from where it has come to. worker, task, k : whose, of what, and which

    left_s, start_s, end_s : seconds of work to its end, and to the moments of taking the tool and of giving it back
    stretch_s : seconds of work to where the stretch under way ends
    at_work : whether it is under way now; begun : whether it was ever
    before  : how much of the task was done when it was drawn; drawn : before human effects, with the moments as shares

    drawn_s, drawn_start, drawn_end : what was drawn, before human effects.
    """

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
