"""Elastic registration of two sequences: S-TSRVF and the best warp between them by dynamic programming.

A sequence becomes q (N, D), constant on N cells of [0, 1]. Warping keeps norms, so minimising |q1 - (q2, gamma)|^2 is
maximising the sum over path edges of sqrt(slope) times the integral of K = q1 q2': D enters through one matrix product.
The edge (p, q) goes p cells of the common clock and q cells of the own time; both step functions are overlaid exactly.
Source: [000] sec. 3.2 (with the L2 norm: as printed, without the square, it is not invariant).
Limits: slopes lie in [1/7, 7]. Within a hold (no speed) q is 0 and says nothing: the path runs straight where it can,
but a long hold in one sequence only drives the warp to its slope limit. Cut holds out before.
Nothing holds a warp near the identity: where postures vary in ways that look like pace, the warp follows them.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import gcd

import numpy as np

from emulator import sphere

STEEPEST = 7
"""Moves are the coprime pairs up to this: 35 slopes from 1/7 to 7."""


def tsrvf(directions: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Transported square-root velocity field of (..., T, B, 3) at the posture ``reference`` (B, 3): (..., T - 1, 3B).

    Velocities are a unit of [0, 1]; where a posture stands still the field is 0. Source: [000] sec. 3.2.
    Raises ValueError where a posture is opposite to the next one or to the reference.
    """
    directions = np.asarray(directions, float)
    cells = directions.shape[-3] - 1
    here = directions[..., :-1, :, :]
    velocity = sphere.transport(
        here, np.broadcast_to(reference, here.shape), sphere.log(here, directions[..., 1:, :, :])
    )
    field = velocity.reshape(*velocity.shape[:-2], -1) * cells
    speed = np.sqrt(np.einsum("...d,...d->...", field, field))[..., None]
    return field / np.sqrt(np.where(speed > 1e-12, speed, np.inf))


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


def optimum(kernel: np.ndarray) -> tuple[float, np.ndarray]:
    """The largest inner product over all warps, and the path's nodes (E, 2) in cells, for K = q1 q2' (N, M).

    Raises ValueError where K is not finite or one side is more than ``STEEPEST`` times longer.
    """
    from emulator.kernels.elastic import fill, way_back

    kernel = _checked(kernel)
    n, m = kernel.shape
    step = moves()
    value, move = np.empty((n + 1, m + 1)), np.zeros((n + 1, m + 1), dtype=np.uint8)
    scratch = np.empty(m + 1), np.empty(m + 1), np.empty(m + 1, dtype=np.int64)
    taps = step.tap_row, step.tap_column, step.tap_weight, step.first
    best = fill(kernel, step.rises, step.runs, *taps, value, move, *scratch)
    return float(best) / n, way_back(move, step.rises, step.runs)


def optimum_numpy(kernel: np.ndarray) -> tuple[float, np.ndarray]:
    """The same as ``optimum`` without compiled code: whole-array taps, then one row of all moves at a time."""
    kernel = _checked(kernel)
    n, m = kernel.shape
    step = moves()
    gains = []
    pairs = list(zip(step.rises.tolist(), step.runs.tolist()))
    for s, (p, q) in enumerate(pairs):
        gain = np.zeros((max(n - p + 1, 0), max(m - q + 1, 0)))
        for t in range(step.first[s], step.first[s + 1]):
            a, b = step.tap_row[t], step.tap_column[t]
            gain += step.tap_weight[t] * kernel[a : a + n - p + 1, b : b + m - q + 1]
        gains.append(gain)
    value, move = np.full((n + 1, m + 1), -1e30), np.zeros((n + 1, m + 1), dtype=np.uint8)
    value[0, 0] = 0.0
    for row in range(1, n + 1):
        reached = np.full((len(gains), m + 1), -1e30)
        for s, (p, q) in enumerate(pairs):
            if row >= p and m >= q:
                reached[s, q:] = value[row - p, : m + 1 - q] + gains[s][row - p]
        move[row], value[row] = reached.argmax(0), reached.max(0)
    nodes = [(n, m)]
    while min(nodes[-1]) > 0:
        p, q = pairs[move[nodes[-1]]]
        nodes.append((nodes[-1][0] - p, nodes[-1][1] - q))
    return float(value[n, m]) / n, np.array(nodes[::-1])


def pair_warp(q1: np.ndarray, q2: np.ndarray) -> np.ndarray:
    """The warp gamma (N + 1,) that brings q2 (M, D) nearest to q1 (N, D), both on the uniform clock of [0, 1].

    Strictly increasing from 0 to 1. For its limits see the module.
    """
    q1, q2 = np.asarray(q1, float), np.asarray(q2, float)
    return best_warp(q1 @ q2.T)[0]


def best_warp(kernel: np.ndarray) -> tuple[np.ndarray, float]:
    """The best warp (N + 1,) for a ready matrix K = q1 q2' (N, M), and the inner product it reaches."""
    n, m = kernel.shape
    inner, nodes = optimum(kernel)
    return np.interp(np.arange(n + 1), nodes[:, 0], nodes[:, 1]) / m, inner


def _checked(kernel: np.ndarray) -> np.ndarray:
    kernel = np.ascontiguousarray(kernel, dtype=float)
    n, m = kernel.shape
    if not np.all(np.isfinite(kernel)):
        raise ValueError("elastic: the matrix of inner products is not finite; look for NaN in the postures")
    if max(n, m) > STEEPEST * min(n, m):
        raise ValueError(f"elastic: {n} cells against {m}: no warp with slopes up to {STEEPEST} joins them")
    return kernel
