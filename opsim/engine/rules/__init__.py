"""Decisions: pure functions of scalars that return a key (a tuple of floats ending in natural rank) or a bool.

They use + - * / comparisons, min and max only, so that a compiled engine can run the same source. Smallest key wins.
"""

from opsim.engine.rules.allocation import ALLOCATION_RULES
from opsim.engine.rules.routing import shortest_queue
from opsim.engine.rules.settle import ARRIVAL, COMPLETION

__all__ = ["ALLOCATION_RULES", "ARRIVAL", "COMPLETION", "shortest_queue"]
