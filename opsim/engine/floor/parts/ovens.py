"""Stations that serve batches."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.floor.machine import Array, List, struct

if TYPE_CHECKING:
    from opsim.engine.floor.parts.state import Job, Station


@struct
class Oven:
    """overdue : whether one of the jobs in the queue may have waited long enough; class_of : (P,)

    line : the jobs in the order of the queue; classes : of those, as they come first; n_of, since_s : (C,) of each, how
    many wait, and since when the first does; together : the next batch
    """

    station: Station
    size: int
    most_wait_s: float
    class_of: Array[int]
    overdue: int
    line: List[Job]
    classes: List[int]
    n_of: Array[int]
    since_s: Array[float]
    together: List[Job]
