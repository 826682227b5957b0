"""How often jobs were through something: counted in lists by rank."""

from __future__ import annotations

from opsim.engine.floor.machine import List, inlined
from opsim.engine.floor.parts.state import Floor


@inlined
def counted(floor: Floor, counts: List[int], rank: int) -> int:
    """How often so far, where it may be that it was never."""
    while len(counts) <= rank:
        counts.append(0)
    return counts[rank]
