"""Arrays that a floor takes while it runs: whole numbers or floats side by side, all 0."""

from __future__ import annotations

from typing import Any

from opsim.engine.fast_engine.machine.compiling import inlined
from opsim.engine.fast_engine.machine.memory import give_bytes_back, take_bytes, words_at
from opsim.engine.fast_engine.machine.structs import address_of, array_at

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
