"""What the fast engine is written in: structs of raw memory, lists of them, and steps that call each other by a table.

The engine is plain Python functions over such structs, compiled one by one. Nothing here knows of factories.
"""

from opsim.engine.fast_engine.machine.arena import Arena as Arena
from opsim.engine.fast_engine.machine.arena import Handle as Handle
from opsim.engine.fast_engine.machine.arrays import give_ints_back as give_ints_back
from opsim.engine.fast_engine.machine.arrays import new_floats as new_floats
from opsim.engine.fast_engine.machine.arrays import new_ints as new_ints
from opsim.engine.fast_engine.machine.arrays import part_of as part_of
from opsim.engine.fast_engine.machine.compiling import inlined as inlined
from opsim.engine.fast_engine.machine.lists import clear as clear
from opsim.engine.fast_engine.machine.lists import drop as drop
from opsim.engine.fast_engine.machine.lists import drop_at as drop_at
from opsim.engine.fast_engine.machine.lists import give_items_back as give_items_back
from opsim.engine.fast_engine.machine.lists import has as has
from opsim.engine.fast_engine.machine.lists import index_of as index_of
from opsim.engine.fast_engine.machine.lists import insert as insert
from opsim.engine.fast_engine.machine.lists import pop_first as pop_first
from opsim.engine.fast_engine.machine.lists import pop_last as pop_last
from opsim.engine.fast_engine.machine.lists import push as push
from opsim.engine.fast_engine.machine.memory import call_out as call_out
from opsim.engine.fast_engine.machine.memory import fresh as fresh
from opsim.engine.fast_engine.machine.memory import give_back as give_back
from opsim.engine.fast_engine.machine.memory import words_at as words_at
from opsim.engine.fast_engine.machine.steps import Call as Call
from opsim.engine.fast_engine.machine.steps import ask_1 as ask_1
from opsim.engine.fast_engine.machine.steps import ask_2 as ask_2
from opsim.engine.fast_engine.machine.steps import ask_3 as ask_3
from opsim.engine.fast_engine.machine.steps import here as here
from opsim.engine.fast_engine.machine.steps import line_of as line_of
from opsim.engine.fast_engine.machine.steps import needed as needed
from opsim.engine.fast_engine.machine.steps import step as step
from opsim.engine.fast_engine.machine.steps import step_of as step_of
from opsim.engine.fast_engine.machine.steps import tell_0 as tell_0
from opsim.engine.fast_engine.machine.steps import tell_1 as tell_1
from opsim.engine.fast_engine.machine.steps import tell_2 as tell_2
from opsim.engine.fast_engine.machine.steps import tell_3 as tell_3
from opsim.engine.fast_engine.machine.structs import NOTHING as NOTHING
from opsim.engine.fast_engine.machine.structs import Array as Array
from opsim.engine.fast_engine.machine.structs import List as List
from opsim.engine.fast_engine.machine.structs import address_of as address_of
from opsim.engine.fast_engine.machine.structs import cast as cast
from opsim.engine.fast_engine.machine.structs import struct as struct
from opsim.engine.fast_engine.machine.table import TABLE as TABLE
from opsim.engine.fast_engine.machine.table import complete as complete
