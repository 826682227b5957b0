"""Distances between sequences of postures: what every two-sample judge is fed with."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from emulator import sphere

_BLOCK = 64


def distances(a: np.ndarray, b: np.ndarray | None = None, *, n_threads: int = 1) -> np.ndarray:
    """Distances (n, m), radians, between sequences a (n, T, B, 3) and b (m, T, B, 3) on one clock; among a without b.

    The mean over time of the summed arcs of the bones, in float32 to a relative 1e-6 (arcs within 0.001 of pi: to
    1e-3). Raises ValueError for unequal shapes, or for what is not finite.
    All time points, always: every third of 301 would count the ends three times and shift a mean distance by 0.15 %,
    which is a tenth of the energy distances that models are told apart by.
    Source: Chen, Park & Srivastava, eq. 1 under the integral of sec. 3.2.
    """
    from emulator.kernels.arcs import add_arcs

    if b is not None and a.shape[1:] != b.shape[1:]:
        raise ValueError(f"distances: sequences are {a.shape[1:]} and {b.shape[1:]}, expected (T, B, 3) alike")
    left = _packed(a)
    right = left if b is None else _packed(b)
    out = np.zeros((len(left), len(right)))
    starts = range(0, len(left), _BLOCK)
    jobs = [(left, right, s, min(s + _BLOCK, len(left)), b is None, out) for s in starts]
    if n_threads == 1:
        for job in jobs:
            add_arcs(*job)
    else:
        with ThreadPoolExecutor(n_threads) as pool:
            for done in [pool.submit(add_arcs, *job) for job in jobs]:
                done.result()
    out /= a.shape[1]
    return out + out.T if b is None else out


def distances_numpy(a: np.ndarray, b: np.ndarray | None = None) -> np.ndarray:
    """The twin of ``distances`` in plain numpy and float64: the definition."""
    other = a if b is None else b
    return np.stack([sphere.distance(sequence, other).mean(axis=-1) for sequence in a])


def _packed(sequences: np.ndarray) -> np.ndarray:
    """Halves of sequences (n, T, B, 3) as (n, 3, T * B) float32: neighbours in memory are worked on together."""
    from emulator.kernels.arcs import halved

    sequences = np.asarray(sequences)
    if sequences.ndim != 4 or sequences.shape[-1] != 3 or sequences.shape[1] == 0:
        raise ValueError(f"distances: found {sequences.shape}, expected (n, T, B, 3)")
    rows = sequences.reshape(len(sequences), -1, 3)
    packed = np.empty((len(rows), 3, rows.shape[1]), np.float32)
    if not halved(rows, packed):
        raise ValueError("distances: a posture is not finite")
    return packed
