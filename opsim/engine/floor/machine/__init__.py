"""What the rules of the floor are written in, where CPython runs them: structs are objects with slots, lists are lists.

The compiled engine has the same names over raw memory, see ``fast_engine.machine``. With ``OPSIM_SANITIZE=1`` some of
them look at what they are given, see ``sanitizer``.
"""

from os import environ

from opsim.engine.floor.machine.arena import Arena as Arena
from opsim.engine.floor.machine.lists import drop as drop
from opsim.engine.floor.machine.lists import drop_at as drop_at
from opsim.engine.floor.machine.lists import give_ints_back as give_ints_back
from opsim.engine.floor.machine.lists import give_items_back as give_items_back
from opsim.engine.floor.machine.lists import has as has
from opsim.engine.floor.machine.lists import index_of as index_of
from opsim.engine.floor.machine.lists import new_floats as new_floats
from opsim.engine.floor.machine.lists import new_ints as new_ints
from opsim.engine.floor.machine.lists import part_of as part_of
from opsim.engine.floor.machine.lists import pop_first as pop_first
from opsim.engine.floor.machine.steps import call_out as call_out
from opsim.engine.floor.machine.steps import here as here
from opsim.engine.floor.machine.steps import inlined as inlined
from opsim.engine.floor.machine.steps import line_of as line_of
from opsim.engine.floor.machine.steps import step as step
from opsim.engine.floor.machine.steps import step_of as step_of
from opsim.engine.floor.machine.structs import NOTHING as NOTHING
from opsim.engine.floor.machine.structs import Array as Array
from opsim.engine.floor.machine.structs import Call as Call
from opsim.engine.floor.machine.structs import Handle as Handle
from opsim.engine.floor.machine.structs import List as List
from opsim.engine.floor.machine.structs import address_of as address_of
from opsim.engine.floor.machine.structs import cast as cast
from opsim.engine.floor.machine.structs import fresh as fresh
from opsim.engine.floor.machine.structs import give_back as give_back
from opsim.engine.floor.machine.structs import struct as struct

if environ.get("OPSIM_SANITIZE", "0") not in ("", "0"):
    from opsim.engine.floor.machine import sanitizer

    globals().update(sanitizer.NAMES)
