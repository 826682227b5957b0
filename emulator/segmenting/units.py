"""Five units of a cyclic movement: preparing, initial, cyclic, final, wind-up.

Source: spatio-temporal LTSA (seed 003), sec. 3.1. Preparing lasts until the first difference of the curve changes
sharply; initial ends, and cyclic begins, where the second difference first is 0 (the first boundary of a cycle); cyclic
lasts until the last such place; final until the coordinates do not change any more; the rest is wind-up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.segmenting.cycles import Cycles

NAMES = ("preparing", "initial", "cyclic", "final", "wind-up")
SHARP = 0.15
"""Still is slower than this share of the curve's typical speed within the cyclic unit (root mean square)."""


@dataclass(frozen=True)
class Unit:
    """Frames ``start`` to ``stop``, the latter not within; of no length where a take has no such unit."""

    name: str
    start: int
    stop: int

    @property
    def n_frames(self) -> int:
        return self.stop - self.start


def units(found: Cycles) -> tuple[Unit, ...]:
    """The five units, in order, without gap, from frame 0 to the last. Raises ValueError where no cycle was found."""
    if len(found.start) == 0:
        raise ValueError("no cycle found: no units to tell apart")
    n = len(found.smooth)
    first, last = round(float(found.boundary[0])), round(float(found.boundary[-1]))
    first_difference = np.abs(np.gradient(found.smooth))
    still = first_difference < SHARP * float(np.sqrt(np.mean(first_difference[first : last + 1] ** 2)))
    moves = _until_it_moves(still[:first])
    rests = n - _until_it_moves(still[last:][::-1])
    edges = (0, moves, first, last, rests, n)
    return tuple(Unit(name, a, b) for name, a, b in zip(NAMES, edges, edges[1:]))


def _until_it_moves(still: np.ndarray) -> int:
    """Frames before the first two in a row that are not still; all of them where there are no such two."""
    moving = ~still
    both = np.flatnonzero(moving[:-1] & moving[1:])
    return int(both[0]) if len(both) else len(still)
