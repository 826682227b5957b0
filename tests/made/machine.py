"""A floor without anything on it, and structs to try the machine with."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from opsim.engine.fast_engine.floor_state import Floor

from opsim.engine.fast_engine.machine import TABLE, Arena, Array, Handle, List, complete, step, struct
from opsim.engine.fast_engine.machine.calling import caller


@struct
class Box:
    """For tests alone."""

    numbers: List[int]
    weights: List[float]
    others: List[Box]
    next: Box
    n: int
    weight: float


@struct
class Given:
    """What Python gives a step that is tried: numbers, arrays of numpy, and a struct or two."""

    a: Array[int]
    b: Array[int]
    c: Array[int]
    floats: Array[float]
    n: int
    m: int
    box: Box
    any: Any


def entered(function: Callable) -> Callable[..., int]:
    """A step of the floor and of what is given, called with the floor's address and fields of ``Given``."""
    made: Any = step(function)
    call = caller(made)

    def called(floor: int, **fields: Any) -> int:
        complete([made])
        given = Arena().new("Given")
        for name, value in fields.items():
            setattr(given, name, value.ctypes.data if isinstance(value, np.ndarray) else value)
        return call(floor, given.address)

    return called


def empty_floor() -> tuple[Arena, Handle]:
    """Memory with a floor that has the table and nothing else; the engine may take more of it."""
    arena = Arena()
    floor = arena.new("Floor")
    floor.memory, floor.table = arena.memory, TABLE.ctypes.data
    return arena, floor


@step
def is_even(floor: Floor, n: int) -> bool:
    """By asking the other one, as steps may."""
    return True if n == 0 else is_odd(floor, n - 1)


@step
def is_odd(floor: Floor, n: int) -> bool:
    return False if n == 0 else is_even(floor, n - 1)
