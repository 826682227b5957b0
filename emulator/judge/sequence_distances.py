"""Distances between sequences of postures: what every two-sample judge is fed with.

Energy distance between two samples, from their matrices of distances: 0 where both have one distribution.

Classical multidimensional scaling: points in the plane that lie about as far apart as sequences do.

Random numbers of their own for each name, so that no part's numbers depend on another part.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from hashlib import blake2b

import numpy as np

from emulator.geometry import sphere

_BLOCK = 64


def distances(a: np.ndarray, b: np.ndarray | None = None, *, n_threads: int = 1) -> np.ndarray:
    """Distances (n, m), radians, between sequences a (n, T, B, 3) and b (m, T, B, 3) on one clock; among a without b.

    The mean over time of the summed arcs of the bones, in float32 to a relative 1e-6 (arcs within 0.001 of pi: to
    1e-3). Raises ValueError for unequal shapes, or for what is not finite.
    All time points, always: every third of 301 would count the ends three times and shift a mean distance by 0.15 %,
    which is a tenth of the energy distances that models are told apart by.
    Source: Chen, Park & Srivastava eq. 4, by eq. 1.
    """
    from emulator.kernels.sphere import add_arcs

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
    from emulator.kernels.sphere import halved

    sequences = np.asarray(sequences)
    if sequences.ndim != 4 or sequences.shape[-1] != 3 or sequences.shape[1] == 0:
        raise ValueError(f"distances: found {sequences.shape}, expected (n, T, B, 3)")
    rows = sequences.reshape(len(sequences), -1, 3)
    packed = np.empty((len(rows), 3, rows.shape[1]), np.float32)
    if not halved(rows, packed):
        raise ValueError("distances: a posture is not finite")
    return packed


def energy_u(between: np.ndarray, among_a: np.ndarray, among_b: np.ndarray) -> float:
    """Energy distance as U-statistic: unbiased, so around 0 (and below it) where the distributions are the same.

    between : (n, m) distances of a to b; among_a (n, n) and among_b (m, m), zero on the diagonal, n and m >= 2
    The distance of an item to itself counts nowhere, so samples of unequal sizes may be compared with one another.
    Source: Rizzo & Szekely (2010), with the diagonals left out of the means.
    """
    n, m = between.shape
    if min(n, m) < 2:
        raise ValueError(f"energy_u: samples of {n} and {m}, expected at least 2 each")
    within = among_a.sum() / (n * (n - 1)) + among_b.sum() / (m * (m - 1))
    return float(2.0 * between.mean() - within)


def energy_stratified(
    between: np.ndarray, among_a: np.ndarray, among_b: np.ndarray, strata_b: np.ndarray, strata_a: np.ndarray | None
) -> float:
    """``energy_u`` for samples with a fixed number of items from each stratum (here: repetitions of each person).

    strata_b (m,), strata_a (n,) : number of each item's stratum; None for independent items
    Without it, pairs from one stratum are rarer in the sample than in the population, its inner distances come out too
    large and the energy too small: by 0.04 of 0.1 on six people with seven repetitions each.
    """
    return float(2.0 * between.mean() - _mean_among(among_a, strata_a) - _mean_among(among_b, strata_b))


def energy_of_size(
    between: np.ndarray,
    among_a: np.ndarray,
    among_b: np.ndarray,
    n_a: int,
    strata_b: np.ndarray | None = None,
    strata_a: np.ndarray | None = None,
) -> float:
    """The V-statistic that ``n_a`` independent items of the law of a would have against b.

    So draws, of which there are as many as one likes, can be held against a few real items, and two ratios of it be
    compared; without strata and with n_a = n it is ``energy_v``. Shapes and strata as ``energy_stratified``.
    """
    within_a, within_b = _mean_among(among_a, strata_a), _mean_among(among_b, strata_b)
    return float(2.0 * between.mean() - (1 - 1 / n_a) * within_a - (1 - 1 / len(among_b)) * within_b)


def _mean_among(among: np.ndarray, strata: np.ndarray | None) -> float:
    """Mean distance of two independent items of the mixture of strata; a stratum of one item has the others' spread.

    Without strata, or where none has two items, all items count as independent.
    """
    if strata is None or len(np.unique(strata)) == len(strata):
        strata = np.zeros(len(among), int)
    members = (strata[:, None] == np.unique(strata)).astype(float)
    count = members.sum(axis=0)
    share, sums = count / count.sum(), members.T @ among @ members
    several = count > 1
    inner = np.diag(sums)[several] / (count[several] * (count[several] - 1))
    means = sums / np.outer(count, count)
    np.fill_diagonal(means, np.average(inner, weights=share[several]))
    means[several, several] = inner
    return float(share @ means @ share)


def energy_v(between: np.ndarray, among_a: np.ndarray, among_b: np.ndarray) -> float:
    """Energy distance as V-statistic: never below 0, above 0 by chance alone. Shapes as ``energy_u``.

    Source: Chen, Park & Srivastava sec. 4.4, epsilon(A, B); Rizzo & Szekely (2010).
    """
    return float(2.0 * between.mean() - among_a.mean() - among_b.mean())


def pooled(between: np.ndarray, among_a: np.ndarray, among_b: np.ndarray) -> np.ndarray:
    """The distances (n + m, n + m) of both samples taken together, a first."""
    return np.block([[among_a, between], [between.T, among_b]])


@dataclass(frozen=True, eq=False)
class Mds:
    """Where the items lie.

    points    : (n, K) centred, K directions in falling order of their spread; in the unit of the distances
    explained : (K,) share of each direction in the sum of all positive eigenvalues
    negative  : share of the negative eigenvalues in the sum of all, by size; 0 for Euclidean distances
    """

    points: np.ndarray
    explained: np.ndarray
    negative: float


def mds(distances: np.ndarray, n_dims: int = 2) -> Mds:
    """Classical scaling of distances (n, n), symmetric, zero on the diagonal; signs fixed, so figures repeat.

    Raises ValueError for no square matrix, or for more directions than n.
    Source: Torgerson (1952); Chen, Park & Srivastava sec. 5.2, figure 15.
    """
    distances = np.asarray(distances, float)
    n = len(distances)
    if distances.shape != (n, n) or not np.allclose(distances, distances.T, rtol=1e-5, atol=1e-9):
        raise ValueError(f"mds: found {distances.shape}, expected symmetric distances (n, n)")
    if not 1 <= n_dims <= n:
        raise ValueError(f"mds: found {n_dims} directions, expected 1 to {n}")
    values, vectors = np.linalg.eigh(_doubly_centred(distances**2))
    positive = np.maximum(values[::-1], 0.0)
    points = vectors[:, ::-1][:, :n_dims] * np.sqrt(positive[:n_dims])
    total, size = positive.sum(), np.abs(values).sum()
    explained = positive[:n_dims] / total if total > 0 else np.zeros(n_dims)
    return Mds(_signed(points), explained, float(1.0 - total / size) if size > 0 else 0.0)


def mds_of_two(
    between: np.ndarray, among_a: np.ndarray, among_b: np.ndarray, n_dims: int = 2
) -> tuple[np.ndarray, np.ndarray, Mds]:
    """Two samples scaled together: points of a (n, K), of b (m, K), and the whole. Shapes as ``energy_u``."""
    whole = mds(pooled(between, among_a, among_b), n_dims)
    return whole.points[: len(among_a)], whole.points[len(among_a) :], whole


def _doubly_centred(squares: np.ndarray) -> np.ndarray:
    """Inner products (n, n) of points about their centre, from squared distances (n, n)."""
    by_row = squares.mean(axis=1, keepdims=True)
    centred = -0.5 * (squares - by_row - by_row.T + squares.mean())
    return (centred + centred.T) / 2


def _signed(points: np.ndarray) -> np.ndarray:
    """Directions turned so that the point farthest out on each lies on its positive side (first of equals)."""
    size = np.abs(points)
    farthest = np.argmax(size >= size.max(axis=0) * (1 - 1e-9), axis=0)
    return points * np.where(points[farthest, np.arange(points.shape[1])] < 0, -1.0, 1.0)


def stream(seed: int, *name: str) -> np.random.Generator:
    """The generator of one named thing, e.g. ``stream(7, "deep_squat", "PWI")``."""
    words = (int.from_bytes(blake2b(part.encode(), digest_size=8).digest(), "big") for part in name)
    return np.random.default_rng([seed, *words])
