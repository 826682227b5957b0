"""A floor without anything on it, and structs to try the machine with."""

from __future__ import annotations

from opsim.engine.fast_engine.floor_state import Floor

from opsim.engine.fast_engine.machine import TABLE, Arena, Handle, List, cast, step, struct
from opsim.ergonomics.kernels.compiled import compiled


@struct
class Box:
    """For tests alone."""

    numbers: List[int]
    weights: List[float]
    others: List[Box]
    next: Box
    n: int
    weight: float


entered = compiled(nogil=True)
"""A function that Python calls."""
as_box, as_floor = cast(Box), cast(Floor)


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
