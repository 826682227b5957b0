"""What opens and closes, and when."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, struct
from opsim.engine.floor.parts.records import Source
from opsim.engine.floor.parts.state import Station


@struct
class Hours:
    """Of a station, or a source. rank : among stations, then sources; shut : whether it is closed at the start

    at_s, opens : n edges, when, and whether it opens; next : the one that comes next; closed : n_closed pairs of times
    saturated : n_saturated sources of that kind, in their order, all of the floor
    """

    station: Station
    source: Source
    rank: int
    shut: int
    n: int
    at_s: Array[float]
    opens: Array[int]
    next: int
    n_closed: int
    closed: Array[float]
    n_saturated: int
    saturated: Array[Source]
