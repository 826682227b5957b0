"""Log-likelihoods of drawn and training coefficients under one density, and their quantiles against one another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

LOWEST = -1e300
"""What a log-likelihood of minus infinity counts as, so that quantiles between it and a finite one exist."""


class HasLogLikelihood(Protocol):
    """Anything that says how likely coefficients are: (n, ...) -> (n,) nats."""

    def log_likelihood(self, scores: np.ndarray, /) -> np.ndarray: ...


@dataclass(frozen=True, eq=False)
class LikelihoodComparison:
    """Log-likelihoods in nats of training (N,) and drawn (n,) items under the density fitted to the training.

    qq : (P, 2) quantiles of training and drawn, P the smaller of N and n; a density that is right has them on y = x
    """

    training: np.ndarray
    drawn: np.ndarray
    qq: np.ndarray

    @property
    def gap(self) -> float:
        """Mean distance of the points from y = x, in standard deviations of the training's log-likelihoods.

        NaN where all training items are equally likely.
        """
        spread = float(np.std(self.training, ddof=1))
        return float(np.abs(self.qq[:, 1] - self.qq[:, 0]).mean() / spread) if spread > 0 else float("nan")


def compare_likelihood(density: HasLogLikelihood, training: np.ndarray, drawn: np.ndarray) -> LikelihoodComparison:
    """Log-likelihoods of training (N, ...) and drawn (n, ...) items, in whatever form the density takes them.

    A model with many numbers finds its own training items less likely than its draws: compare unseen ones, too.
    Source: Chen, Park & Srivastava sec. 4.4 (1), eq. 7 and figure 19.
    """
    of_training, of_drawn = (np.atleast_1d(density.log_likelihood(items)) for items in (training, drawn))
    return LikelihoodComparison(of_training, of_drawn, qq_points(of_training, of_drawn))


def qq_points(reference: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Quantiles (P, 2) of two samples (N,) and (n,) at the shares (i - 1/2) / P, P the smaller of N and n.

    Samples of one size are simply sorted. Minus infinity counts as ``LOWEST``.
    Raises ValueError for an empty sample and for what is not a number.
    """
    reference, other = (np.asarray(values, float).ravel() for values in (reference, other))
    for name, values in (("reference", reference), ("other", other)):
        if values.size == 0 or np.isnan(values).any():
            found = f"{np.isnan(values).sum()} of {values.size} not numbers" if values.size else "an empty sample"
            raise ValueError(f"qq_points: {name}: found {found}, expected numbers")
    count = min(reference.size, other.size)
    shares = (np.arange(count) + 0.5) / count
    return np.stack([np.quantile(np.maximum(v, LOWEST), shares, method="hazen") for v in (reference, other)], axis=-1)
