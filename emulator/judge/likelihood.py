"""Log-likelihoods of drawn and training coefficients under one density, and their quantiles against one another.

The two-level simulation: as many sequences as one likes from a known law, to try schemes on.

Level one: a simple scheme is fitted to the recordings and draws a thousand sequences, the truth from here on, dealt out
for training and testing. Level two: each scheme is fitted to the training, and its draws are held against the test.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from emulator.judge.posture_tests import disco
from emulator.judge.sequence_distances import distances, energy_u, pooled, stream

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


class FittedScheme(Protocol):
    """What a scheme must do: draw sequences (n, T, B, 3), and say how likely sequences are, (n, T, B, 3) -> (n,)."""

    def sample(self, n: int, rng: np.random.Generator, /) -> np.ndarray: ...

    def log_likelihood(self, sequences: np.ndarray, /) -> np.ndarray: ...


Fit = Callable[[str, np.ndarray], FittedScheme]


@dataclass(frozen=True, eq=False)
class TwoLevelRow:
    """One scheme at level two.

    p, energy  : DISCO of its draws against the test; energy distance as U-statistic
    qq         : (P, 2) quantiles of the log-likelihoods of test and draws under the law of level one
    """

    level_one: str
    level_two: str
    p: float
    energy: float
    qq: np.ndarray


def two_level(
    sequences: np.ndarray,
    level_one: str,
    level_two: Iterable[str],
    fit: Fit,
    *,
    seed: int = 0,
    n_train: int = 800,
    n_test: int = 200,
    n_drawn: int = 200,
    n_permutations: int = 999,
) -> list[TwoLevelRow]:
    """A row for each name in ``level_two``, from aligned sequences (N, T, B, 3).

    fit : ``fit(name, sequences)`` gives a fitted scheme
    Likelihoods are those of level one, which is the true law here. A scheme's row does not depend on the other schemes.
    Source: Chen, Park & Srivastava sec. 5.3, table 3, figure 19 (there 60 sequences, 1,000 drawn, 800/200).
    """
    truth = fit(level_one, sequences)
    known = truth.sample(n_train + n_test, stream(seed, "level one", level_one))
    train, test = known[:n_train], known[n_train:]
    among_test, likely = distances(test), truth.log_likelihood(test)
    rows = []
    for name in level_two:
        drawn = fit(name, train).sample(n_drawn, stream(seed, "level two", level_one, name))
        parts = distances(drawn, test), distances(drawn), among_test
        tested = disco(pooled(*parts), n_drawn, stream(seed, "permutations", level_one, name), n_permutations)
        qq = qq_points(likely, truth.log_likelihood(drawn))
        rows.append(TwoLevelRow(level_one, name, tested.p, energy_u(*parts), qq))
    return rows
