"""How many components of space and of time: by reconstruction error and a two-sample test, as in sec. 5.1."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from emulator.judge.disco import disco
from emulator.judge.distance import distances
from emulator.judge.reconstruction import reconstruction_error
from emulator.reduce import SequentialPCA
from emulator.schemes.reductions import spanned

SPACES, TIMES = (1, 2, 3, 5, 8, 10, 12, 16, 20, 30), (1, 2, 4, 7, 10, 15, 20, 30, 40)
GAIN, LEVEL, WITHIN, N_PERMUTATIONS = 0.04, 0.05, 1.1, 199


class Representation(Protocol):
    """Directions (n, T, B, 3) to flat (n, T', C) and start (n, S), and back."""

    def forward(self, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]: ...
    def inverse(self, flat: np.ndarray, start: np.ndarray) -> np.ndarray: ...


@dataclass(frozen=True)
class DimensionSearch:
    """What was tried and found (the paper's figure 13).

    d1, d2 : numbers tried; error : (len(d1), len(d2)) mean reconstruction error, radians (eq. 5)
    p      : (len(d2),) of the two-sample test of originals against reconstructions at the chosen d1
    chosen : (d1, d2)
    """

    d1: tuple[int, ...]
    d2: tuple[int, ...]
    error: np.ndarray
    p: np.ndarray
    chosen: tuple[int, int]


def search_dimensions(
    representation: Representation, directions: np.ndarray, rng: np.random.Generator
) -> DimensionSearch:
    """Numbers of components for directions (N, T, B, 3), as the paper looks for them, by a rule it does not print.

    d1 is the first from which on a further component lowers the error (with all functions of time) by less than a
    twenty-fifth of what one component leaves; d2 the first whose reconstructions the test does not tell from the
    originals at 0.05, with an error within a tenth of that of all functions. The test alone would take one function:
    it forgives what each reconstruction has in common with its original.
    """
    flat, start = representation.forward(directions)
    most = spanned(flat, SPACES[-1], TIMES[-1])
    d1, d2 = _upto(SPACES, most[0]), _upto(TIMES, most[1])
    whole = SequentialPCA.fit(flat, d1[-1], d2[-1])

    def rebuilt(i: int, j: int) -> np.ndarray:
        part = SequentialPCA(whole.mean, whole.spatial[:i], whole.temporal_mean[:i], whole.temporal[:i, :j])
        return representation.inverse(part.inverse(part.forward(flat)), start)

    error = np.array([[reconstruction_error(directions, rebuilt(i, j)) for j in d2] for i in d1])
    gain = -np.diff(error[:, -1]) / np.diff(d1)
    at = int(np.argmax(np.append(gain < GAIN * error[0, -1], True)))
    p = np.array([_p(directions, rebuilt(d1[at], j), rng) for j in d2])
    good = (p > LEVEL) & (error[at] <= WITHIN * error[at, -1])
    return DimensionSearch(d1, d2, error, p, (d1[at], d2[int(np.argmax(good))] if good.any() else d2[-1]))


def _p(directions: np.ndarray, rebuilt: np.ndarray, rng: np.random.Generator) -> float:
    both = distances(np.concatenate([directions, rebuilt]))
    return disco(both, len(directions), rng, N_PERMUTATIONS).p


def _upto(tried: tuple[int, ...], largest: int) -> tuple[int, ...]:
    return (*(d for d in tried if d < largest), largest) if largest <= tried[-1] else tried
