"""Where something goes wrong, or is looked at. See ``quality``."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, List, struct
from opsim.engine.floor.parts.records import Stream


@struct
class Chances:
    """Streams of an operation, by visit x sources + source."""

    streams: List[Stream]


@struct
class Gauge:
    """Of a station, see ``plan.QualityPlan``. back : by product x n_steps + step, -1: nowhere; n_steps 0: always scrap

    yields, chances : by operation
    """

    station: int
    yield_share: float
    inspects: int
    finds: float
    false_alarms: float
    by_worker: int
    n_steps: int
    back: Array[int]
    most: float
    yields: Array[Chances]
    chances: Array[Chances]
