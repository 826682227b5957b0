"""Lists inside structs: grown from both ends in constant time, changed in the middle by moving what is behind."""

from __future__ import annotations

from typing import Any

from opsim.engine.fast_engine.machine.compiling import inlined
from opsim.engine.fast_engine.machine.memory import give_bytes_back, take_bytes, words_at
from opsim.engine.fast_engine.machine.structs import set_word, word

DATA, FIRST, N, ROOM = range(4)
"""The words of a list. NOTE: its items lie from the FIRST on, so that taking the first one moves nothing."""


@inlined
def _make_room(floor: Any, items: Any) -> None:
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
