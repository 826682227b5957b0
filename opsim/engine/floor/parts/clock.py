"""Time on the grid, as ``opsim.clock`` has it; and the lowest bit of a word: what a processor does at once."""

from math import inf, nan

from opsim.clock import on_grid as on_grid

TICKS, STEP = 2.0**20, 2.0**-20
INF, NAN = inf, nan


def rounded(number: float) -> float:
    """To the nearest whole number, halves to the even one."""
    return float(round(number))


def on_grid_from_0(delay_s: float) -> float:
    """``on_grid`` for what may be 0, or negative."""
    return round(delay_s * TICKS) * STEP


def lowest_bit(bits: int) -> int:
    """The number of the lowest bit that is set; of 0: 64."""
    return (bits & -bits).bit_length() - 1 if bits else 64
