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

import numpy as np

from emulator import geodesic, sphere
from emulator.moves import STEEPEST, moves, tables

GENTLE = 2
"""The three slopes of the first, rough path: it reaches 99 % of the optimum in 3 % of the time."""
Energies = tuple[np.ndarray, np.ndarray]


def tsrvf(directions: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Transported square-root velocity field of (..., T, B, 3) at the posture ``reference`` (B, 3): (..., T - 1, 3B).

    Velocities are a unit of [0, 1]; where a posture stands still the field is 0. Source: [000] sec. 3.2.
    Raises ValueError where a posture is opposite to the next one or to the reference.
    """
    from emulator.kernels.fields import root_speed, transported

    *batch, n_times, n_bones, _ = np.shape(directions)
    postures = np.ascontiguousarray(directions, dtype=float).reshape(-1, n_times, 3 * n_bones)
    fields = np.empty((len(postures), n_times - 1, 3 * n_bones))
    flat_reference = np.array(reference, dtype=float).ravel()
    for sequence, field in zip(postures, fields):
        if transported(sequence, flat_reference, geodesic.inverse_sine(), geodesic.LARGEST_CHORD_SQUARE, field):
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
    from emulator.kernels.elastic import way_back

    return best / len(kernel), way_back(kernel, *tables(STEEPEST), *rows)


def _filled(kernel: np.ndarray, steepest: int, tails: Energies, bound: float) -> tuple[float, tuple[np.ndarray, ...]]:
    """The optimum in cells, and the rows of the dynamic programme with the columns where they begin and end."""
    from emulator.kernels.elastic import fill

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
