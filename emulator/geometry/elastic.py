"""Square-root velocity fields carried along warps.

Soft landmarks: marks as extra channels of the fields, so that registration is rewarded where marks meet.

A mark at own time t adds the channel sqrt(c) exp(-(s - t)^2 / (2 h^2)). A path through (s, t) of two such channels
gains their product, a Gaussian ridge about the place where the marks meet, as if it were added to the matrix K. The
channels are warped and averaged like all others, so that the mark of the template is the mean of the warped marks, and
the objective of the group alignment stays a squared distance that never rises.
Off where it is not asked for. Made work with 0.01 rad of tracking noise and exact marks: warps near the marks are
wrong by 26-40 % less in reaching, picking, placing. But clean recordings say as much without marks (no warp got better
or worse by more than 0.03 frames of 100), and in six recorded classes the time of the turn in held-out repetitions was
drawn no better (Kolmogorov-Smirnov distance 0.214 with and without), though in training the marks came together.

The moves of the elastic dynamic programme: p cells of the common clock for q cells of the own time.

Both step functions are overlaid exactly along a move, so its gain is a short sum of entries of K: its taps.

Elastic registration of two sequences: S-TSRVF and the best warp between them by dynamic programming.

A sequence becomes q (N, D), constant on N cells of [0, 1]. Warping keeps norms, so minimising |q1 - (q2, gamma)|^2 is
maximising the sum over path edges of sqrt(slope) times the integral of K = q1 q2': D enters through one matrix product.
The edge (p, q) goes p cells of the common clock and q cells of the own time; both step functions are overlaid exactly.
Source: Chen, Park & Srivastava sec. 3.2 (with the L2 norm: as printed, without the square, it is not invariant).
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

from emulator.geometry import flattening, sphere


def warped(fields: np.ndarray, warps: np.ndarray) -> np.ndarray:
    """(q o gamma) sqrt(gamma') of fields (N, cells, D), averaged exactly over each cell of the common clock.

    warps (N, T) on the common clock; the answer is (N, T - 1, D).
    """
    from emulator.kernels.warping import warp_field

    out = np.empty((len(fields), warps.shape[1] - 1, fields.shape[2]))
    for field, gamma, to in zip(np.ascontiguousarray(fields), np.ascontiguousarray(warps), out):
        warp_field(field, gamma, to)
    return out


def warped_numpy(fields: np.ndarray, warps: np.ndarray) -> np.ndarray:
    """The same as ``warped`` without compiled code, by differences of running sums."""
    rise = np.diff(warps, axis=-1)
    mean = np.stack([_mean_over(q, gamma) for q, gamma in zip(fields, warps)])
    return mean * np.sqrt(rise * rise.shape[1])[..., None]


def _mean_over(field: np.ndarray, gamma: np.ndarray) -> np.ndarray:
    """The mean of a step function (cells, D) over each interval between successive gamma: (T - 1, D)."""
    cells = len(field)
    area = np.concatenate([np.zeros((1, field.shape[1])), np.cumsum(field, axis=0)]) / cells
    low = np.minimum((gamma * cells).astype(int), cells - 1)
    share = (gamma * cells - low)[:, None]
    return np.diff(area[low] * (1.0 - share) + area[low + 1] * share, axis=0) / np.diff(gamma)[:, None]


STRENGTH = 0.01
"""What two marks that meet gain, as a share of a sequence's length (squared norm); see ``WIDTH``."""
WIDTH = 0.04
"""Standard deviation h of the bump in own unit time: labels scatter by about a quarter of it."""


def channels(marks: np.ndarray, n_cells: int, length: float, strength: float, width: float = WIDTH) -> np.ndarray:
    """Channels (N, cells, E) of marks (N, E) in own unit time; ``length`` is the mean squared norm of the fields.

    Raises ValueError for marks outside [0, 1], a negative strength or a width that is not positive.
    """
    marks = np.asarray(marks, float)
    if not (strength >= 0 and width > 0):
        raise ValueError(f"landmarks: strength {strength} must be 0 or more, width {width} above 0")
    if not np.all((marks >= 0) & (marks <= 1)):
        raise ValueError("landmarks: marks must lie in [0, 1] of their own unit time")
    middle = (np.arange(n_cells) + 0.5) / n_cells
    bump = np.exp(-((middle[:, None] - marks[:, None, :]) ** 2) / (2 * width**2))
    return bump * np.sqrt(strength * length / (width * np.sqrt(np.pi)))


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


GENTLE = 2
"""The three slopes of the first, rough path: it reaches 99 % of the optimum in 3 % of the time."""
Energies = tuple[np.ndarray, np.ndarray]


def tsrvf(directions: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Transported square-root velocity field of (..., T, B, 3) at the posture ``reference`` (B, 3): (..., T - 1, 3B).

    Velocities are a unit of [0, 1]; where a posture stands still the field is 0.
    Source: Chen, Park & Srivastava sec. 3.2.
    Raises ValueError where a posture is opposite to the next one or to the reference.
    """
    from emulator.kernels.warping import root_speed, transported

    *batch, n_times, n_bones, _ = np.shape(directions)
    postures = np.ascontiguousarray(directions, dtype=float).reshape(-1, n_times, 3 * n_bones)
    fields = np.empty((len(postures), n_times - 1, 3 * n_bones))
    flat_reference = np.array(reference, dtype=float).ravel()
    for sequence, field in zip(postures, fields):
        if transported(sequence, flat_reference, flattening.inverse_sine(), flattening.LARGEST_CHORD_SQUARE, field):
            field[:] = tsrvf_numpy(sequence.reshape(n_times, n_bones, 3), reference)
        else:
            root_speed(field)
    return fields.reshape(*batch, n_times - 1, 3 * n_bones)


def tsrvf_numpy(directions: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """The same as ``tsrvf`` without compiled code, for steps of any size."""
    directions = np.asarray(directions, float)
    cells = directions.shape[-3] - 1
    here = directions[..., :-1, :, :]
    velocity = sphere.transport(
        here, np.broadcast_to(reference, here.shape), sphere.log(here, directions[..., 1:, :, :])
    )
    field = velocity.reshape(*velocity.shape[:-2], -1) * cells
    speed = np.sqrt(np.einsum("...d,...d->...", field, field))[..., None]
    return field / np.sqrt(np.where(speed > 1e-12, speed, np.inf))


def optimum(kernel: np.ndarray, energies: Energies | None = None) -> tuple[float, np.ndarray]:
    """The largest inner product over all warps, and the path's nodes (E, 2) in cells, for K = q1 q2' (N, M).

    energies : squared norms of the rows of q1 (N,) and of q2 (M,). Given them, nodes that no best path can pass are
               left out: what remains to be gained is at most |rest of q1| |rest of q2| (Cauchy-Schwarz), and the best
               path with slopes of 1/2, 1 and 2 alone, found first, says what must be reached. The answer is the same.
    Raises ValueError where K is not finite or one side is more than ``STEEPEST`` times longer.
    """
    kernel = _checked(kernel)
    tails = np.zeros(kernel.shape[0] + 1), np.zeros(kernel.shape[1] + 1)
    bound = -np.inf
    if energies is not None:
        bound = _filled(kernel, GENTLE, tails, bound)[0]
        for tail, energy in zip(tails, energies):
            tail[:-1] = np.sqrt(np.cumsum(energy[::-1])[::-1])
        bound -= 1e-9 * tails[0][0] * tails[1][0]
    best, rows = _filled(kernel, STEEPEST, tails, bound)
    from emulator.kernels.warping import way_back

    return best / len(kernel), way_back(kernel, *tables(STEEPEST), *rows)


def _filled(kernel: np.ndarray, steepest: int, tails: Energies, bound: float) -> tuple[float, tuple[np.ndarray, ...]]:
    """The optimum in cells, and the rows of the dynamic programme with the columns where they begin and end."""
    from emulator.kernels.warping import fill

    n, m = kernel.shape
    rows = np.empty((n + 1, m + 1)), np.empty(n + 1, dtype=np.int64), np.empty(n + 1, dtype=np.int64)
    return float(fill(kernel, *tables(steepest), tails, bound, *rows, np.empty(m + 1))), rows


def optimum_numpy(kernel: np.ndarray) -> tuple[float, np.ndarray]:
    """The same as ``optimum`` without compiled code: whole-array taps, then one row of all moves at a time."""
    kernel = _checked(kernel)
    n, m = kernel.shape
    step = moves()
    gains = []
    pairs = list(zip(step.rises.tolist(), step.runs.tolist()))
    for s, (p, q) in enumerate(pairs):
        gain = np.zeros((max(n - p + 1, 0), max(m - q + 1, 0)))
        for t in range(step.first[s], step.first[s + 1]) if gain.size else ():
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
    return best_warp(np.asarray(q1, float), np.asarray(q2, float))[0]


def best_warp(q1: np.ndarray, q2: np.ndarray) -> tuple[np.ndarray, float]:
    """``pair_warp`` and the inner product it reaches."""
    inner, nodes = optimum(q1 @ q2.T, (energy(q1), energy(q2)))
    return np.interp(np.arange(len(q1) + 1), nodes[:, 0], nodes[:, 1]) / len(q2), inner


def energy(q: np.ndarray) -> np.ndarray:
    """Squared norms (N,) of the rows of q (N, D)."""
    return np.asarray(np.einsum("nd,nd->n", q, q))


def _checked(kernel: np.ndarray) -> np.ndarray:
    kernel = np.ascontiguousarray(kernel, dtype=float)
    n, m = kernel.shape
    if not np.all(np.isfinite(kernel)):
        raise ValueError("elastic: the matrix of inner products is not finite; look for NaN in the postures")
    if max(n, m) > STEEPEST * min(n, m):
        raise ValueError(f"elastic: {n} cells against {m}: no warp with slopes up to {STEEPEST} joins them")
    return kernel
