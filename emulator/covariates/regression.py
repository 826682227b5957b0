"""Partial least squares of one score at a time (PLS1), on standardised covariates, for many scores and folds at once.

Written here and not taken from scikit-learn: that would be a heavy dependency of every run for thirty lines, and its
one fit at a time is far too slow for a leave-one-out of every score. Its numbers are the test.

How well covariates foretell the scores of a person who had no part in the fit: leave one person out.

Is a forecast better than noise makes one look? A bar for leave-one-out R^2 by numbers without any structure.

Leave-one-out R^2 is above 0 for 15-40 % of scores that are pure noise (4 to 40 people, four covariates). So it must
also pass what standard normal numbers reach on the same covariates, folds and choice of components, as Horn's parallel
analysis does for eigenvalues. Tried on made cohorts (60 scores, 6 of them explained): R^2 > 0 alone, R^2 above its
standard error, the 95 % bar score by score, the same with the false discovery rate controlled over the scores. The
last one left the smallest error for new people from 4 people to 40; docs/emulator.md has the figures.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

NOTHING = 1e-10
"""Share of a score's covariance with the covariates below which no further component is looked for."""


def slopes_of_products(gram: np.ndarray, cross: np.ndarray, n_components: int) -> np.ndarray:
    """Slopes on X with 0, 1, ... components, (A + 1, ..., P, K), from the products X'X (..., P, P) and X'y (..., P, K).

    Each column of ``cross`` is a score of its own. X and y are centred; X is scaled by whoever makes the products.
    A score that nothing more is to be said of keeps its slopes.
    Source: NIPALS for one response (Wold 1975; Geladi & Kowalski 1986) written in the products, as Dayal & MacGregor
    (1997), "Improved PLS algorithms", algorithm 1: X'y is deflated, X is not touched.
    """
    left, slope = cross, np.zeros_like(cross)
    least = NOTHING * np.sqrt(_inner(cross, cross))
    found: list[np.ndarray] = [slope]
    weights: list[np.ndarray] = []
    loadings: list[np.ndarray] = []
    for _ in range(n_components):
        size = np.sqrt(_inner(left, left))
        weight = left * np.where(size > least, 1.0 / np.where(size > least, size, 1.0), 0.0)
        rotated = weight
        for before, load in zip(weights, loadings):
            rotated = rotated - _inner(load, weight) * before
        image = gram @ rotated
        square = _inner(rotated, image)
        load = image * np.where(square > 0, 1.0 / np.where(square > 0, square, 1.0), 0.0)
        told = _inner(rotated, left)
        slope = slope + rotated * np.where(square > 0, told / np.where(square > 0, square, 1.0), 0.0)
        left = left - load * told
        weights.append(rotated)
        loadings.append(load)
        found.append(slope)
    return np.stack(found)


def _inner(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.einsum("...pk,...pk->...k", one, other)[..., None, :]


def pls1(x: np.ndarray, y: np.ndarray, n_components: int) -> tuple[np.ndarray, np.ndarray]:
    """Intercepts (A + 1, K) and slopes (A + 1, P, K) of y (N, K) on x (N, P) with 0, 1, ... components.

    A covariate that does not vary gets slope 0. Raises ValueError for fewer than two rows.
    """
    if len(x) < 2:
        raise ValueError(f"partial least squares: found {len(x)} rows, expected 2 or more")
    centre, middle = x.mean(axis=0), y.mean(axis=0)
    spread = spread_of(np.mean((x - centre) ** 2, axis=0), 1e-20 * np.mean(x**2, axis=0))
    scaled = (x - centre) / spread
    slopes = slopes_of_products(scaled.T @ scaled, scaled.T @ (y - middle), n_components) / spread[:, None]
    return middle - np.einsum("p,apk->ak", centre, slopes), slopes


def spread_of(variance: np.ndarray, rounding: np.ndarray) -> np.ndarray:
    """Standard deviations; infinite where the variance is only rounding: no slope then."""
    return np.where(variance > rounding, np.sqrt(np.maximum(variance, 1e-300)), np.inf)


@dataclass(frozen=True, eq=False)
class Folds:
    """Covariates x (R, P), each of the G people left out once; ``groups`` (R,) says whose row it is, 0 to G - 1.

    What depends on the covariates alone is done once, so that real scores and noise can be asked in turn.
    mean (G, P), spread (G, P), gram (G, P, P) of the standardised covariates, all of the others' rows
    """

    x: np.ndarray
    groups: np.ndarray
    n_others: np.ndarray
    mean: np.ndarray
    spread: np.ndarray
    gram: np.ndarray

    @classmethod
    def of(cls, x: np.ndarray, groups: np.ndarray) -> Folds:
        """The folds of rows x (R, P) that ``groups`` (R,) numbers."""
        x = x - x.mean(axis=0)
        n_own, sums = np.bincount(groups), summed(x, groups)
        squares = summed(x[:, :, None] * x[:, None, :], groups)
        n_others = np.maximum(len(x) - n_own, 1).astype(float)
        mean = (sums.sum(axis=0) - sums) / n_others[:, None]
        inner = squares.sum(axis=0) - squares - n_others[:, None, None] * mean[:, :, None] * mean[:, None, :]
        variance = np.einsum("gpp->gp", inner) / n_others[:, None]
        spread = spread_of(variance, 1e-10 * np.mean(x**2, axis=0))
        return cls(x, groups, n_others, mean, spread, inner / (spread[:, :, None] * spread[:, None, :]))

    @property
    def n_people(self) -> int:
        return len(self.n_others)

    def slopes(self, y: np.ndarray, n_components: int) -> tuple[np.ndarray, np.ndarray]:
        """Means of the others (G, K), and slopes (A + 1, G, P, K) of y (R, K) with 0, 1, ... components."""
        middle = y.mean(axis=0)
        y = y - middle
        sums = summed(y, self.groups)
        mean = (sums.sum(axis=0) - sums) / self.n_others[:, None]
        products = np.empty((self.n_people, self.x.shape[1], y.shape[1]))
        for p, column in enumerate(self.x.T):
            products[:, p] = summed(column[:, None] * y, self.groups)
        inner = products.sum(axis=0) - products - (self.n_others[:, None] * self.mean)[:, :, None] * mean[:, None, :]
        scaled = inner / self.spread[:, :, None]
        return mean + middle, slopes_of_products(self.gram, scaled, n_components) / self.spread[:, :, None]

    def r2(self, y: np.ndarray, n_components: int) -> np.ndarray:
        """(A + 1, K) 1 - squared errors of rows y (R, K) foretold by the others' fit over those of the others' mean."""
        mean, slopes = self.slopes(y, n_components)
        away, left = self.x - self.mean[self.groups], y - mean[self.groups]
        squares = np.stack([_squares(left - _product(away, slope, self.groups)) for slope in slopes])
        return np.where(squares[0] > 0, 1.0 - squares / np.where(squares[0] > 0, squares[0], 1.0), 0.0)


def summed(values: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """Sums (G, ...) of the rows (R, ...) of each group."""
    if _each_alone(groups):
        return values
    n = int(groups.max()) + 1
    own = np.zeros((n, len(groups)))
    own[groups, np.arange(len(groups))] = 1.0
    return (own @ values.reshape(len(groups), -1)).reshape(n, *values.shape[1:])


def _each_alone(groups: np.ndarray) -> bool:
    return np.array_equal(groups, np.arange(len(groups)))


def _product(away: np.ndarray, slope: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """Each row (R, P) times its group's slope (G, P, K): (R, K)."""
    own = slope if _each_alone(groups) else slope[groups]
    return np.einsum("rp,rpk->rk", away, own)


def _squares(left: np.ndarray) -> np.ndarray:
    return np.einsum("rk,rk->k", left, left)


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
