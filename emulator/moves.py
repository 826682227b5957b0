"""The moves of the elastic dynamic programme: p cells of the common clock for q cells of the own time.

Both step functions are overlaid exactly along a move, so its gain is a short sum of entries of K: its taps.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import gcd

import numpy as np

STEEPEST = 7
"""Moves are the coprime pairs up to this: 35 slopes from 1/7 to 7."""


@dataclass(frozen=True)
class Moves:
    """The moves of the dynamic programme and their taps: K[row, column] enters move s with ``tap_weight`` cells."""

    rises: np.ndarray
    runs: np.ndarray
    tap_row: np.ndarray
    tap_column: np.ndarray
    tap_weight: np.ndarray
    first: np.ndarray


@lru_cache(maxsize=4)
def moves(steepest: int = STEEPEST) -> Moves:
    """Coprime moves (p, q) up to ``steepest``; (1, 1) comes first, so that a tie is resolved straight ahead."""
    pairs = [(p, q) for p in range(1, steepest + 1) for q in range(1, steepest + 1) if gcd(p, q) == 1]
    taps: list[tuple[int, int, float]] = []
    first = [0]
    for p, q in pairs:
        edges = sorted({*map(Fraction, range(p + 1)), *(Fraction(j * p, q) for j in range(q + 1))})
        for low, high in pairwise(edges):
            middle = (low + high) / 2
            taps.append((int(middle), int(middle * Fraction(q, p)), float(high - low) * np.sqrt(q / p)))
        first.append(len(taps))
    rows, columns, weights = zip(*taps)
    as_int = [
        np.array(part, dtype=np.int64) for part in ([p for p, _ in pairs], [q for _, q in pairs], rows, columns, first)
    ]
    return Moves(as_int[0], as_int[1], as_int[2], as_int[3], np.array(weights), as_int[4])


@lru_cache(maxsize=4)
def tables(steepest: int) -> tuple[np.ndarray, ...]:
    """``moves`` as the kernel reads them: an odd number of taps is made even by one of weight 0."""
    step = moves(steepest)
    taps = np.stack([step.tap_row, step.tap_column, step.tap_weight])
    parts = [taps[:, a:b] for a, b in pairwise(step.first)]
    even = [np.append(part, part[:, -1:] * [[1], [1], [0]], axis=1) if part.shape[1] % 2 else part for part in parts]
    row, column, weight = np.concatenate(even, axis=1)
    first = np.cumsum([0, *(part.shape[1] for part in even)])
    return step.rises, step.runs, row.astype(np.int64), column.astype(np.int64), weight, first
