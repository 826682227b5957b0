"""Energy distance between two samples, from their matrices of distances: 0 where both have one distribution."""

from __future__ import annotations

import numpy as np


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
