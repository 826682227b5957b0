"""Is a forecast better than noise makes one look? A bar for leave-one-out R^2 by numbers without any structure.

Leave-one-out R^2 is above 0 for 15-40 % of scores that are pure noise (4 to 40 people, four covariates). So it must
also pass what standard normal numbers reach on the same covariates, folds and choice of components, as Horn's parallel
analysis does for eigenvalues. Tried on made cohorts (60 scores, 6 of them explained): R^2 > 0 alone, R^2 above its
standard error, the 95 % bar score by score, the same with the false discovery rate controlled over the scores. The
last one left the smallest error for new people from 4 people to 40; DESIGN.md has the figures.
"""

from __future__ import annotations

import numpy as np

from emulator.covariates.left_out import Folds, summed

SEED, MOST, FEWEST, WORK = 20, 1000, 200, 40_000
"""The numbers are the same for the same covariates, whatever the seed of a fit: a fit has no luck of its own."""
TAIL, BEYOND = 0.10, 0.02


def noise_p(folds: Folds, y: np.ndarray, r2: np.ndarray, n_components: int) -> np.ndarray:
    """(K,) how often noise reaches the best leave-one-out R^2 (K,) of scores y (R, K).

    Where people have several rows, the noise of a score has as much in common within a person as the score has, to the
    next quarter above: heights foretell what is common by luck far more easily than what changes from row to row.
    """
    if folds.n_people == len(folds.groups):
        return p_of_noise(r2, noise_r2(folds, n_components))
    quarters = np.ceil(np.clip(4 * common_share(y, folds.groups), 1, 4))
    p = np.empty(len(r2))
    for quarter in np.unique(quarters):
        at = quarters == quarter
        p[at] = p_of_noise(r2[at], noise_r2(folds, n_components, quarter / 4))
    return p


def noise_r2(folds: Folds, n_components: int, common: float = 1.0) -> np.ndarray:
    """(M,) the best leave-one-out R^2 over 1, 2, ... components of M noise scores.

    common : share of a noise score's variance that all rows of a person have in common
    """
    rng = np.random.default_rng(SEED)
    n = int(np.clip(WORK // len(folds.groups), FEWEST, MOST))
    noise = np.sqrt(common) * rng.standard_normal((folds.n_people, n))[folds.groups]
    if common < 1:
        noise += np.sqrt(1 - common) * rng.standard_normal(noise.shape)
    return np.concatenate([best_r2(folds, noise[:, start : start + 100], n_components) for start in range(0, n, 100)])


def common_share(y: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """(K,) share of the variance of y (R, K) that a person's rows have in common, by one-way analysis of variance."""
    counts = np.bincount(groups).astype(float)
    mean = summed(y, groups) / counts[:, None]
    within = np.sum((y - mean[groups]) ** 2, axis=0) / max(len(y) - len(counts), 1)
    between = counts @ (mean - y.mean(axis=0)) ** 2 / max(len(counts) - 1, 1)
    size = (len(y) - np.sum(counts**2) / len(y)) / max(len(counts) - 1, 1)
    shared = np.maximum((between - within) / size, 0.0)
    return np.where(shared + within > 0, shared / np.maximum(shared + within, 1e-300), 1.0)


def best_r2(folds: Folds, y: np.ndarray, n_components: int) -> np.ndarray:
    """(K,) the best leave-one-out R^2 over 1, 2, ... components."""
    return np.asarray(folds.r2(y, n_components)[1:].max(axis=0))


def p_of_noise(r2: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """(K,) how often noise (M,) reaches r2 (K,).

    Beyond the uppermost fiftieth of the noise by the exponential tail of its upper tenth in -log(1 - R^2), which is how
    the tail of an R^2 of normal numbers falls (there 1 - R^2 is a beta number): a thousand draws then tell 1 in 10,000.
    """
    told, drawn = _strength(r2), np.sort(_strength(noise))
    n_tail, n_beyond = max(int(TAIL * len(drawn)), 1), max(int(BEYOND * len(drawn)), 1)
    excess = float(np.mean(drawn[-n_tail:]) - drawn[-n_tail - 1])
    edge = drawn[-n_beyond - 1]
    counted = (1.0 + len(drawn) - np.searchsorted(drawn, told, side="left")) / (len(drawn) + 1.0)
    beyond = n_beyond / len(drawn) * np.exp(-(told - edge) / max(excess, 1e-12))
    return np.where(told > edge, beyond, counted)


def _strength(r2: np.ndarray) -> np.ndarray:
    return np.asarray(-np.log(np.maximum(1.0 - r2, 1e-12)))


def kept(p: np.ndarray, level: float, keep: str, families: np.ndarray | None = None) -> np.ndarray:
    """(K,) which scores pass: "each" by itself at ``level``, or "fdr", where 1 - level of those kept are false at most.

    families : (K,) numbers; scores of one family are corrected for one another, or None for all as one family
    Source: Benjamini & Hochberg (1995). NaN (not tested) never passes.
    """
    p = np.where(np.isnan(p), 1.0, p)
    if keep == "each":
        return np.asarray(p < 1 - level)
    family = np.zeros(len(p), int) if families is None else np.asarray(families)
    passed = np.zeros(len(p), bool)
    for one in np.unique(family):
        at = np.flatnonzero(family == one)
        order = at[np.argsort(p[at])]
        fine = np.flatnonzero(p[order] <= (1 - level) * np.arange(1, len(order) + 1) / len(order))
        passed[order[: fine[-1] + 1 if len(fine) else 0]] = True
    return passed
