"""Lists inside structs, and arrays that a floor takes while it runs."""

from __future__ import annotations

from typing import Any


def pop_first(items: list[Any]) -> Any:
    """Take the first item out. There must be one."""
    return items.pop(0)


def drop_at(items: list[Any], at: int) -> None:
    """Take the item number ``at`` out."""
    del items[at]


def index_of(items: list[Any], item: Any) -> int:
    """The number of the first that is the item; -1: none is."""
    return items.index(item) if item in items else -1


def has(items: list[Any], item: Any) -> bool:
    """Whether one of them is the item."""
    return item in items


def drop(items: list[Any], item: Any) -> bool:
    """Take the first that is the item out; whether there was one."""
    if item in items:
        items.remove(item)
        return True
    return False


def give_items_back(_floor: Any, items: list[Any]) -> None:
    """Take all items out: before the struct with the list in it is given back."""
    items.clear()


def new_ints(_floor: Any, n: int) -> list[int]:
    """An array of n whole numbers."""
    return [0] * n


def new_floats(_floor: Any, n: int) -> list[float]:
    """An array of n floats."""
    return [0.0] * n


def give_ints_back(_floor: Any, _items: list[int], _n: int) -> None:
    """An array of n that nobody refers to any more."""


class _Part:
    """What stands in an array from one on."""

    __slots__ = ("_first", "_items")

    def __init__(self, items: list[int], first: int):
        self._items, self._first = items, first

    def __getitem__(self, item: int) -> int:
        return self._items[self._first + item]


def part_of(items: list[int], first: int) -> Any:
    """What stands in an array of whole numbers from one on."""
    return _Part(items, first)
