"""Memory while the engine runs: structs, arrays, and lists inside structs.

It comes from the end of a chunk, or from what was given back. Lists grow from both ends in constant time, and are
changed in the middle by moving what is behind.
"""

from __future__ import annotations

from collections.abc import Callable
from math import copysign, fmod
from typing import Any

from opsim.engine.fast_engine.machine.expressions import LISTS
from opsim.engine.fast_engine.machine.intrinsics import (
    Helper,
    address_of,
    array_at,
    call_out,
    cast,
    divided,
    float_floor,
    remainder,
    set_word,
    word,
    words_at,
)
from opsim.engine.fast_engine.machine.structs import Array, List, size_of, struct

inlined = Helper


def apart(function: Callable) -> Any:
    """A helper that is called, as it is seldom needed."""
    return Helper(function, "noinline cold")


SMALL, CLASSES = 128, 192
"""Sizes below SMALL x 16 bytes have a list of their own of what was given back; larger ones one for each power of 2,
to which they are rounded up."""


@struct
class Memory:
    """at, end : what is left of the last chunk; more : address of the function that makes another one

    free : by class of size, the first of what was given back, each leading to the next
    """

    at: int
    end: int
    more: int
    free: Array[int]


@inlined
def class_of(n_bytes: int) -> int:
    """The class of a size, which is a multiple of 16."""
    if n_bytes < 16 * SMALL:
        return n_bytes // 16
    found, room = SMALL, 16 * SMALL
    while room < n_bytes:
        room <<= 1
        found += 1
    return found


@inlined
def room_of(which: int) -> int:
    """Bytes of a class."""
    return 16 * which if which < SMALL else (16 * SMALL) << (which - SMALL)


@inlined
def take_bytes(memory: Memory, n_bytes: int) -> int:
    """Address of so many bytes, a multiple of 16, all 0. Raises MemoryError."""
    which = class_of(n_bytes)
    at = memory.free[which]
    if at:
        memory.free[which] = words_at(at)[0]
    else:
        room = room_of(which)
        if memory.at + room > memory.end:
            call_out(memory.more, 0, room)
            if memory.at + room > memory.end:
                raise MemoryError
        at = memory.at
        memory.at = at + room
    words = words_at(at)
    for i in range(n_bytes >> 3):
        words[i] = 0
    return at


@inlined
def give_bytes_back(memory: Memory, at: int, n_bytes: int) -> None:
    """They can be taken again, for something as large."""
    which = class_of(n_bytes)
    words_at(at)[0] = memory.free[which]
    memory.free[which] = at


def fresh(struct_of: Any) -> Any:
    """A compiled function of the floor that gives a new struct, all its fields 0 or nothing."""
    n_bytes, made = size_of(struct_of), cast(struct_of)

    @inlined
    def new(floor: Any) -> Any:
        return made(take_bytes(floor.memory, n_bytes))

    return new


def give_back(struct_of: Any) -> Any:
    """A compiled function of the floor and a struct that nobody refers to any more."""
    n_bytes = size_of(struct_of)

    @inlined
    def give(floor: Any, one: Any) -> None:
        give_bytes_back(floor.memory, address_of(one), n_bytes)

    return give


_ints_at, _floats_at = array_at("int"), array_at("float")


@inlined
def new_ints(floor: Any, n: int) -> Any:
    """An array of n whole numbers."""
    return _ints_at(take_bytes(floor.memory, 16 * ((n + 1) >> 1)))


@inlined
def new_floats(floor: Any, n: int) -> Any:
    """An array of n floats."""
    return _floats_at(take_bytes(floor.memory, 16 * ((n + 1) >> 1)))


@inlined
def give_ints_back(floor: Any, items: Any, n: int) -> None:
    """An array of n that nobody refers to any more."""
    give_bytes_back(floor.memory, address_of(items), 16 * ((n + 1) >> 1))


@inlined
def part_of(items: Any, first: int) -> Any:
    """What stands in an array of whole numbers from one on."""
    return words_at(address_of(items) + 8 * first)


DATA, FIRST, N, ROOM = range(4)
"""The words of a list. NOTE: its items lie from the FIRST on, so that taking the first one moves nothing."""


@apart
def _make_room(floor: Any, items: List[Any]) -> None:
    """Room for one more behind the last: by moving up to the beginning, or in twice as much memory."""
    data, first, n = word(items, DATA), word(items, FIRST), word(items, N)
    room: int = word(items, ROOM)
    old = words_at(data)
    if first > room // 2:
        for i in range(n):
            old[i] = old[first + i]
    else:
        larger = max(4, 2 * room)
        made = take_bytes(floor.memory, 8 * larger)
        new = words_at(made)
        for i in range(n):
            new[i] = old[first + i]
        if room:
            give_bytes_back(floor.memory, data, 8 * room)
        set_word(items, DATA, made)
        set_word(items, ROOM, larger)
    set_word(items, FIRST, 0)


@inlined
def push(floor: Any, items: Any, item: Any) -> None:
    """Put an item behind the last."""
    n = len(items)
    if word(items, FIRST) + n >= word(items, ROOM):
        _make_room(floor, items)
    set_word(items, N, n + 1)
    items[n] = item


@inlined
def insert(floor: Any, items: Any, at: int, item: Any) -> None:
    """Put an item before the one that is now number ``at``."""
    n = len(items)
    if word(items, FIRST) + n >= word(items, ROOM):
        _make_room(floor, items)
    set_word(items, N, n + 1)
    for i in range(n, at, -1):
        items[i] = items[i - 1]
    items[at] = item


@inlined
def pop_first(items: Any) -> Any:
    """Take the first item out. There must be one."""
    item = items[0]
    set_word(items, FIRST, word(items, FIRST) + 1)
    set_word(items, N, len(items) - 1)
    return item


@inlined
def pop_last(items: Any) -> Any:
    """Take the last item out. There must be one."""
    item = items[len(items) - 1]
    set_word(items, N, len(items) - 1)
    return item


@inlined
def drop_at(items: Any, at: int) -> None:
    """Take the item number ``at`` out."""
    n = len(items)
    if at == 0:
        set_word(items, FIRST, word(items, FIRST) + 1)
    else:
        for i in range(at, n - 1):
            items[i] = items[i + 1]
    set_word(items, N, n - 1)


@inlined
def index_of(items: Any, item: Any) -> int:
    """The number of the first that is the item; -1: none is."""
    for i in range(len(items)):
        if items[i] == item:
            return i
    return -1


@inlined
def has(items: Any, item: Any) -> bool:
    """Whether one of them is the item."""
    return index_of(items, item) >= 0


@inlined
def drop(items: Any, item: Any) -> bool:
    """Take the first that is the item out; whether there was one."""
    at = index_of(items, item)
    if at >= 0:
        drop_at(items, at)
    return at >= 0


@inlined
def give_items_back(floor: Any, items: Any) -> None:
    """Take all items out, and their room is free: before the struct with the list in it is given back."""
    room = word(items, ROOM)
    if room:
        give_bytes_back(floor.memory, word(items, DATA), 8 * room)
    set_word(items, FIRST, 0)
    set_word(items, N, 0)
    set_word(items, ROOM, 0)


@inlined
def clear(items: Any) -> None:
    """Take all items out; their room stays."""
    set_word(items, FIRST, 0)
    set_word(items, N, 0)


@inlined
def floor_of_ints(a: int, b: int) -> int:
    """``a // b``."""
    quotient = divided(a, b)
    return quotient - 1 if (a < 0) != (b < 0) and quotient * b != a else quotient


@inlined
def rest_of_ints(a: int, b: int) -> int:
    """``a % b``."""
    rest = remainder(a, b)
    return rest + b if rest != 0 and (rest < 0) != (b < 0) else rest


@inlined
def rest_of_floats(a: float, b: float) -> float:
    """``a % b``, as CPython has it."""
    rest = fmod(a, b)
    if rest != 0.0:
        return rest + b if (b < 0.0) != (rest < 0.0) else rest
    return copysign(0.0, b)


@inlined
def floor_of_floats(a: float, b: float) -> float:
    """``a // b``, as CPython has it."""
    quotient = (a - fmod(a, b)) / b
    rest = fmod(a, b)
    if rest != 0.0 and (b < 0.0) != (rest < 0.0):
        quotient -= 1.0
    if quotient == 0.0:
        return copysign(0.0, a / b)
    whole = float_floor(quotient)
    return whole + 1.0 if quotient - whole > 0.5 else whole


LISTS |= {
    **{"append": push, "insert": insert, "pop_first": pop_first, "pop_last": pop_last, "drop_at": drop_at},
    **{"has": has, "clear": clear, "floor_of_ints": floor_of_ints, "floor_of_floats": floor_of_floats},
    **{"rest_of_ints": rest_of_ints, "rest_of_floats": rest_of_floats},
}
