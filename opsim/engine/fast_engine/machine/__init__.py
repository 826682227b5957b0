"""What the fast engine is written in: structs of raw memory, lists of them, and steps that call each other by a table.

The engine is plain Python functions over such structs, compiled one by one. Nothing here knows of factories.
"""

from opsim.engine.fast_engine.machine.arena import Arena, Handle
from opsim.engine.fast_engine.machine.compiling import inlined
from opsim.engine.fast_engine.machine.lists import (
    call_out,
    clear,
    drop,
    drop_at,
    fresh,
    give_back,
    give_ints_back,
    give_items_back,
    has,
    index_of,
    insert,
    new_floats,
    new_ints,
    part_of,
    pop_first,
    pop_last,
    push,
    words_at,
)
from opsim.engine.fast_engine.machine.steps import (
    Call,
    Step,
    ask_1,
    ask_2,
    ask_3,
    here,
    line_of,
    needed,
    step,
    step_of,
    tell_0,
    tell_1,
    tell_2,
    tell_3,
)
from opsim.engine.fast_engine.machine.structs import NOTHING, Array, List, address_of, cast, struct
from opsim.engine.fast_engine.machine.table import TABLE, complete

__all__ = [
    "NOTHING", "TABLE", "Arena", "Array", "Call", "Handle", "List", "Step", "address_of", "ask_1", "ask_2", "ask_3",
    "call_out", "cast", "clear", "complete", "drop", "drop_at", "fresh", "give_back", "give_ints_back",
    "give_items_back", "has", "here", "index_of", "inlined", "insert", "line_of", "needed", "new_floats", "new_ints",
    "part_of", "pop_first", "pop_last", "push", "step", "step_of", "struct", "tell_0", "tell_1", "tell_2", "tell_3",
    "words_at",
]  # fmt: skip
