"""Decisions: pure functions of scalars that return a key (a tuple of floats ending in natural rank) or a bool.

They use + - * / comparisons, min and max only, so that a compiled engine can run the same source. Smallest key wins.
"""

from opsim.engine.rules.allocation import ALLOCATION_RULES
from opsim.engine.rules.release import source_in_turn, stock_wanted
from opsim.engine.rules.repair import longest_down
from opsim.engine.rules.rotation import ROTATION_RULES
from opsim.engine.rules.routing import ROUTING_RULES, shortest_queue
from opsim.engine.rules.sequencing import SEQUENCING_RULES
from opsim.engine.rules.settle import ARRIVAL, BREAKDOWN, CALENDAR, COMPLETION, REPAIR
from opsim.engine.rules.transport import nearest_stop, soonest_there, walks_to_carry

__all__ = [
    "ALLOCATION_RULES",
    "ARRIVAL",
    "BREAKDOWN",
    "CALENDAR",
    "COMPLETION",
    "REPAIR",
    "ROTATION_RULES",
    "ROUTING_RULES",
    "SEQUENCING_RULES",
    "longest_down",
    "nearest_stop",
    "shortest_queue",
    "soonest_there",
    "source_in_turn",
    "stock_wanted",
    "walks_to_carry",
]
