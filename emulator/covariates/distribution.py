"""The covariates of the training people as one Gaussian: what an unknown one is expected to be, given the known.

What a category (sex) adds to the numbers of a body: a linear model on what partial least squares leaves.

Source: Baydal-Bertomeu et al., eq. 5 and table 2: the effect of a score counts where its F test passes 95 %. Their
test has a degree of freedom for each recording; here each person is one, since six runs of one woman are one woman.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

ROUNDS, SETTLED = 50, 1e-4


@dataclass(frozen=True, eq=False)
class CovariateGaussian:
    """mean (V,) and covariance (V, V) of the covariates."""

    mean: np.ndarray
    covariance: np.ndarray

    @classmethod
    def fit(cls, rows: np.ndarray, n_people: int) -> CovariateGaussian:
        """From rows (R, V) of ``n_people``, NaN where unknown; each covariate known at least twice and varying.

        The EM algorithm for a normal sample with gaps; correlations are shrunk by 1.2 / n_people, at most 0.3, so that
        three people do not tie five covariates to each other. Source: Little & Rubin, Statistical Analysis with Missing
        Data, sec. 11.2.
        """
        centre, spread = np.nanmean(rows, axis=0), np.nanstd(rows, axis=0)
        scaled = (rows - centre) / spread
        patterns, rho = list(zip(*np.unique(np.isnan(scaled), axis=0, return_counts=True))), min(0.3, 1.2 / n_people)
        guess = cls(np.zeros(rows.shape[1]), np.eye(rows.shape[1]))
        for _ in range(ROUNDS if len(patterns) > 1 or patterns[0][0].any() else 1):
            filled = guess.filled(scaled)
            unsure = sum((n * guess.unsure(gap) for gap, n in patterns), np.zeros_like(guess.covariance))
            mean = filled.mean(axis=0)
            covariance = ((filled - mean).T @ (filled - mean) + unsure) / len(rows)
            before, guess = guess, cls(mean, covariance * (1 - rho) + rho * np.diag(np.diag(covariance)))
            if np.abs(guess.covariance - before.covariance).max(initial=0.0) < SETTLED:
                break
        return cls(centre + spread * guess.mean, guess.covariance * np.outer(spread, spread))

    def filled(self, rows: np.ndarray) -> np.ndarray:
        """Rows (R, V) with NaN replaced by the conditional mean given what the row knows."""
        out, gaps = rows.copy(), np.isnan(rows)
        for gap in np.unique(gaps[gaps.any(axis=1)], axis=0):
            at = np.flatnonzero(np.all(gaps == gap, axis=1))
            out[np.ix_(at, gap)] = self.mean[gap] + (rows[np.ix_(at, ~gap)] - self.mean[~gap]) @ self._slope(gap).T
        return out

    def unsure(self, gap: np.ndarray) -> np.ndarray:
        """(V, V) conditional covariance of the covariates in ``gap`` (V,) given the others, 0 elsewhere."""
        left = np.zeros_like(self.covariance)
        if gap.any():
            inner = np.ix_(gap, gap)
            left[inner] = self.covariance[inner] - self._slope(gap) @ self.covariance[np.ix_(~gap, gap)]
        return left

    def _slope(self, gap: np.ndarray) -> np.ndarray:
        """Regression (gaps, known) of the unknown on the known."""
        known = self.covariance[np.ix_(~gap, ~gap)]
        return np.asarray(np.linalg.lstsq(known, self.covariance[np.ix_(~gap, gap)], rcond=1e-10)[0].T)


FEWEST_PEOPLE = 2
"""A level of one person would be that person."""


def words_of_people(category: Sequence[str | None], groups: np.ndarray) -> list[str | None]:
    """The first known word of each of the G people whose rows (R,) ``groups`` numbers; None where none is known."""
    words: list[str | None] = [None] * (int(groups.max()) + 1 if len(groups) else 0)
    for word, g in zip(category, groups):
        words[g] = word if words[g] is None else words[g]
    return words


def levels_of(category: Sequence[str | None] | None) -> tuple[str, ...]:
    """The levels that ``FEWEST_PEOPLE`` have, in order of the alphabet; none if fewer than two levels do."""
    said = [one for one in category or () if one is not None]
    found = tuple(sorted(level for level in set(said) if said.count(level) >= FEWEST_PEOPLE))
    return found if len(found) > 1 else ()


def members(category: Sequence[str | None] | None, levels: tuple[str, ...]) -> np.ndarray:
    """(G, C) 1 where a person is of a level; a row of zeros for another level or none."""
    return np.array([[float(one == level) for level in levels] for one in category or ()]).reshape(-1, len(levels))


def level_effects(residual: np.ndarray, member: np.ndarray) -> np.ndarray:
    """(C, K) mean residual (G, K) of each level, the mean over the people of all levels taken off."""
    counts = member.sum(axis=0)
    mean = (member.T @ residual) / counts[:, None]
    return np.asarray(mean - counts @ mean / counts.sum())


def f_test(residual: np.ndarray, member: np.ndarray) -> np.ndarray:
    """(K,) p values of the one-way F test that all levels have one mean residual (G, K); NaN if it cannot be made."""
    from scipy.special import fdtrc

    n, n_levels = int(member.sum()), member.shape[1]
    if n_levels < 2 or n <= n_levels:
        return np.full(residual.shape[1], np.nan)
    inside = residual[member.any(axis=1)]
    own = member[member.any(axis=1)]
    means = (own.T @ inside) / own.sum(axis=0)[:, None]
    between = np.sum(own.sum(axis=0)[:, None] * (means - inside.mean(axis=0)) ** 2, axis=0) / (n_levels - 1)
    within = np.sum((inside - own @ means) ** 2, axis=0) / (n - n_levels)
    ratio = between / np.where(within > 0, within, 1.0)
    return np.where(within > 0, fdtrc(n_levels - 1, n - n_levels, ratio), np.nan)


def left_out_effects(residual: np.ndarray, member: np.ndarray) -> np.ndarray:
    """(G, K) the effect of each person's level by the others: residual (G, G, K) of person h under the fit without g.

    0 for a person of no level, or whose level nobody else is of.
    """
    others = member[None] * (1.0 - np.eye(len(member)))[:, :, None]
    counts = others.sum(axis=1)
    mean = np.einsum("ghc,ghk->gck", others, residual) / np.maximum(counts, 1.0)[:, :, None]
    grand = np.einsum("gc,gck->gk", counts, mean) / np.maximum(counts.sum(axis=1), 1.0)[:, None]
    alone = (counts == 0)[:, :, None]
    effect = np.where(alone, 0.0, mean - grand[:, None])
    return np.asarray(np.einsum("gc,gck->gk", member, effect))
