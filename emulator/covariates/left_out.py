"""How well covariates foretell the scores of a person who had no part in the fit: leave one person out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.covariates.pls import slopes_of_products, spread_of


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
