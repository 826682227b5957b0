"""DISCO: are two samples of sequences from one distribution? A permutation test on their distances.

Are drawn sequences as far from the training sequences as unseen real ones are? A copier is not.

How roughly postures change: the way they go from step to step, and its acceleration on their spheres.

What a reduction loses of sequences that it was not fitted to.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.geometry import sphere
from emulator.geometry.flattening import Flattening
from emulator.model.reduction import JointPCA

_BLOCK = 200


@dataclass(frozen=True)
class Disco:
    """What the test found.

    energy  : energy distance of the two samples (V-statistic), the statistic of the paper
    f       : F of distance components, S / (W / (N - 2)); for two samples a rising function of ``energy``
    p       : (1 + number of permutations at least as far apart) / (1 + ``n_permutations``), in (0, 1]
    """

    energy: float
    f: float
    p: float
    n_permutations: int


def disco(distances: np.ndarray, n_first: int, rng: np.random.Generator, n_permutations: int = 999) -> Disco:
    """Test the first ``n_first`` of N items against the rest, from their distances (N, N), all at once.

    The permutations come out of matrix products: with Z (P, N) the 0/1 members of the first sample, the sums within it
    are the row sums of (Z D) * Z, for which three quarters of D are enough; ``_BLOCK`` permutations at a time stay in
    the cache.
    Raises ValueError where a sample is empty.
    Source: Rizzo & Szekely (2010); Chen, Park & Srivastava sec. 4.4.
    """
    n = len(distances)
    if not 0 < n_first < n:
        raise ValueError(f"disco: the first sample has {n_first} of {n} items, expected 1 to {n - 1}")
    first = (np.arange(n) < n_first).astype(float)[None]
    given, within = _energies(distances, first, n_first)
    blocks = [min(_BLOCK, n_permutations - start) for start in range(0, n_permutations, _BLOCK)]
    drawn = [_energies(distances, _divisions(size, n, n_first, rng), n_first)[0] for size in blocks]
    energy = np.concatenate([given, *drawn])
    reached = int(np.sum(energy[1:] >= energy[0] - 1e-12 * np.abs(energy).max()))
    p = (1 + reached) / (1 + n_permutations)
    between = n_first * (n - n_first) / (2 * n) * energy[0]
    return Disco(float(energy[0]), float(between * (n - 2) / within[0]) if within[0] > 0 else np.inf, p, n_permutations)


def _divisions(size: int, n: int, n_first: int, rng: np.random.Generator) -> np.ndarray:
    """Random divisions (size, n): 1 for the items with the ``n_first`` smallest of n random keys.

    Keys of 24 bits are drawn and sorted in half the time; a row in which two tie for the last place is drawn again.
    """
    keys = rng.random((size, n), dtype=np.float32)
    members = (keys <= np.sort(keys, axis=1)[:, n_first - 1, None]).astype(float)
    tied = np.flatnonzero(members.sum(axis=1) != n_first)
    if len(tied):
        members[tied] = _divisions(len(tied), n, n_first, rng)
    return members


def _energies(distances: np.ndarray, members: np.ndarray, n_first: int) -> tuple[np.ndarray, np.ndarray]:
    """Energy distances (P,) of each division ``members`` (P, N), and their dispersions within."""
    n_second = len(distances) - n_first
    inside, touching = _inside(distances, members), members @ distances.sum(axis=1)
    across = touching - inside
    outside = distances.sum() - inside - 2 * across
    energy = 2 * across / (n_first * n_second) - inside / n_first**2 - outside / n_second**2
    return energy, inside / (2 * n_first) + outside / (2 * n_second)


def _inside(distances: np.ndarray, members: np.ndarray) -> np.ndarray:
    """(P,) sums of the symmetric distances within the first sample: both corners, and one side of them doubled."""
    half = len(distances) // 2
    left, right = np.ascontiguousarray(members[:, :half]), np.ascontiguousarray(members[:, half:])
    corner = left @ distances[:half, :half]
    other = left @ (2.0 * distances[:half, half:]) + right @ distances[half:, half:]
    return np.asarray(np.einsum("pn,pn->p", corner, left) + np.einsum("pn,pn->p", other, right))


def novelty(drawn_to_training: np.ndarray, unseen_to_training: np.ndarray) -> float:
    """Median distance of drawn sequences to the nearest training one, over that of unseen real ones.

    drawn_to_training (n, N), unseen_to_training (m, N) : distances; about 1 is honest, near 0 a copy
    NaN where half of the unseen lie on a training sequence.
    """
    usual = np.median(unseen_to_training.min(axis=1))
    return float(np.median(drawn_to_training.min(axis=1)) / usual) if usual > 0 else float("nan")


def temporal_roughness(directions: np.ndarray) -> float:
    """Mean distance (radians, summed over bones) of successive postures of sequences (n, T, B, 3).

    A wandering of the size of a step shows, a fine trembling hardly: see ``roughness``.
    Source: Chen, Park & Srivastava sec. 5.2, d_Y(alpha(t), alpha(t + 1)) with eq. 1.
    """
    return float(np.mean([sphere.distance(one[1:], one[:-1]).mean() for one in directions]))


def roughness(directions: np.ndarray) -> float:
    """Mean length (radians per step squared) of the second difference of sequences (n, T, B, 3) along their spheres.

    The second difference of unit vectors, less its part towards the middle one (bending of the sphere, not of the
    path); root sum of squares over the bones, mean over times and sequences. T >= 3.
    """
    if directions.shape[1] < 3:
        raise ValueError(f"roughness: sequences of {directions.shape[1]} postures, expected at least 3")
    return float(np.mean([_second_difference(sequence) for sequence in directions]))


def _second_difference(sequence: np.ndarray) -> float:
    middle = sequence[1:-1]
    around = sequence[2:] + sequence[:-2]
    along = around - np.einsum("tbc,tbc->tb", around, middle)[..., None] * middle
    return float(np.sqrt(np.einsum("tbc,tbc->t", along, along)).mean())


def reconstruction_error(sequences: np.ndarray, again: np.ndarray) -> float:
    """Mean distance (radians, summed over bones, mean over time) of sequences (n, T, B, 3) and their likes.

    Source: Chen, Park & Srivastava eq. 5.
    """
    return float(np.mean([sphere.distance(one, other).mean() for one, other in zip(sequences, again)]))


def joint_reconstruction(flatten: Flattening, reduce: JointPCA, sequences: np.ndarray) -> np.ndarray:
    """Sequences (n, T, B, 3) as their joint components give them back."""
    tangent = flatten.forward(sequences)
    flat = tangent.reshape(len(tangent), -1)
    return flatten.inverse(reduce.inverse(reduce.forward(flat)).reshape(tangent.shape))
