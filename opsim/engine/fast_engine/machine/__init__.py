"""What the fast engine is written in: structs of raw memory, lists of them, and steps that call each other by a table.

The engine is plain Python functions over such structs, whose syntax is turned into LLVM's language. Nothing here knows
of factories.
"""

from opsim.engine.fast_engine.machine.arena import Arena, Handle
from opsim.engine.fast_engine.machine.intrinsics import address_of, call_out, cast, words_at
from opsim.engine.fast_engine.machine.lists import (
    clear,
    drop,
    drop_at,
    fresh,
    give_back,
    give_ints_back,
    give_items_back,
    has,
    index_of,
    inlined,
    insert,
    new_floats,
    new_ints,
    part_of,
    pop_first,
    pop_last,
    push,
)
from opsim.engine.fast_engine.machine.steps import Call, Step, here, line_of, step, step_of
from opsim.engine.fast_engine.machine.structs import NOTHING, Array, List, struct
from opsim.engine.fast_engine.machine.table import TABLE, complete

__all__ = [
    "NOTHING", "TABLE", "Arena", "Array", "Call", "Handle", "List", "Step", "address_of", "call_out", "cast", "clear",
    "complete", "drop", "drop_at", "fresh", "give_back", "give_ints_back", "give_items_back", "has", "here", "index_of",
    "inlined", "insert", "line_of", "new_floats", "new_ints", "part_of", "pop_first", "pop_last", "push", "step",
    "step_of", "struct", "words_at",
]  # fmt: skip
