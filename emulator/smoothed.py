"""The density beyond one Gaussian: recorded repetitions, each blurred by a little low-rank noise of the joint vector.

One Gaussian fills the gaps between kinds of execution with movements nobody made: its draws lie twice as far from the
nearest recording as unseen repetitions do. A smoothed bootstrap that keeps variances (Silverman & Young 1987) does not.
A known worker is drawn from his own repetitions, and with the weight of ``BASE`` repetitions from what all others do,
about his shrunk mean: the predictive of a Dirichlet process (Ferguson 1973, sec. 5) with the crew as base measure.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from emulator.density import LowRankNormal
from emulator.law import Law
from emulator.margin import within_worker

BASE = 1.0


@dataclass(frozen=True, eq=False)
class SmoothedScores:
    """Recorded joint coordinates and the noise that blurs them.

    scores : (N, K); owner : (N,) number of the worker of each
    reach  : (N,) factor on the noise about each; smaller where repetitions lie close together
    factor : (R, K) noise is reach * xi @ factor, xi (R,) standard normal
    spread : (K,) within-worker standard deviations that draws are to have
    """

    scores: np.ndarray
    owner: np.ndarray
    reach: np.ndarray
    factor: np.ndarray
    spread: np.ndarray

    @cached_property
    def noise(self) -> LowRankNormal:
        """The noise at reach 1."""
        return LowRankNormal(np.zeros(self.factor.shape[1]), self.factor, np.linalg.norm(self.factor, axis=0), 0.0)

    @cached_property
    def means(self) -> np.ndarray:
        """(W, K) mean of each worker's repetitions."""
        return np.stack([self.scores[self.owner == w].mean(axis=0) for w in range(self.owner.max() + 1)])

    @cached_property
    def deviations(self) -> np.ndarray:
        """(N, K) from the worker's mean, drawn in where with the noise a coordinate varied more than ``spread``.

        Never drawn out: coordinates without noise are fine detail, which would get rough.
        """
        deviation = within_worker(self.scores, self.owner)
        variance = np.mean(deviation**2, axis=0)
        left = np.maximum(self.spread**2 - np.mean(self.reach**2) * self.noise.spread**2, 0.0)
        return np.asarray(deviation * np.sqrt(np.minimum(left / np.maximum(variance, 1e-18), 1.0)))

    def anyone(self, mean: np.ndarray, people: LowRankNormal | None = None) -> Law:
        """The law of somebody never seen with this mean (K,), or of one of these people: all deviations alike."""
        n = len(self.scores)
        return Law(np.full(n, 1.0 / n), self.deviations, self.reach, self.noise, mean, people)

    def known(self, number: int, shrunk_mean: np.ndarray) -> Law:
        """The law of a worker seen in training: his own repetitions, and a little of what others do."""
        own, n = self.owner == number, len(self.scores)
        weight = np.append(np.ones(own.sum()), np.full(n, BASE / n)) / (own.sum() + BASE)
        mean = np.concatenate([self.means[number] - shrunk_mean + self.deviations[own], self.deviations])
        return Law(weight, mean, np.append(self.reach[own], self.reach), self.noise, shrunk_mean)
