"""How often jobs were through something: counted in lists by rank."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import List, inlined, push
from opsim.engine.fast_engine.parts.state import Floor


@inlined
def counted(floor: Floor, counts: List[int], rank: int) -> int:
    """How often so far, where it may be that it was never."""
    while len(counts) <= rank:
        push(floor, counts, 0)
    return counts[rank]
