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
FEWEST_OWN, N_MIXED, MOST_MIXED = 5, 3, 0.2


@dataclass(frozen=True, eq=False)
class SmoothedScores:
    """Recorded joint coordinates and the noise that blurs them.

    scores : (N, K); owner : (N,) number of the worker of each
    reach  : (N,) factor on the noise about each; smaller where repetitions lie close together
    factor : (R, K) noise is reach * xi @ factor, xi (R,) standard normal
    spread : (K,) within-worker standard deviations that draws are to have
    partner : (N, P) recordings that each is mixed with, itself for none; P = 0: nothing is mixed
    drawn_in : (K,) what deviations from a worker's mean are multiplied by, to leave room for the noise; of coordinates
               that curves tell of, what is left of them
    tells    : (C, K - C) what the first C coordinates, curves, tell of all others: their regression within workers
    """

    scores: np.ndarray
    owner: np.ndarray
    reach: np.ndarray
    factor: np.ndarray
    spread: np.ndarray
    drawn_in: np.ndarray
    partner: np.ndarray
    tells: np.ndarray

    @cached_property
    def noise(self) -> LowRankNormal:
        """The noise at reach 1."""
        return LowRankNormal(np.zeros(self.factor.shape[1]), self.factor, np.linalg.norm(self.factor, axis=0), 0.0)

    @cached_property
    def means(self) -> np.ndarray:
        """(W, K) mean of each worker's repetitions."""
        return np.stack([self.scores[self.owner == w].mean(axis=0) for w in range(self.owner.max() + 1)])

    @cached_property
    def sources(self) -> tuple[np.ndarray, np.ndarray]:
        """(M,) the recording that each component goes by, and (M, K) its deviation from the worker's mean, drawn in.

        Each is a mixture of a recording with one that is near it, mostly of the first, at its length: on common clocks
        that goes farther from both than smooth noise does, no rougher than they are, and stays within a kind of
        execution. What its curves tell of all else is told by the mixture, as drawn in.
        """
        first, deviation = self._mixed(less_told(within_worker(self.scores, self.owner), self.tells) * self.drawn_in)
        return first, with_told(deviation, self.tells)

    def _mixed(self, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        n, n_partners = self.partner.shape
        if n_partners == 0:
            return np.arange(n), own
        first, second = np.repeat(np.arange(n), n_partners), self.partner.ravel()
        share = np.where(first == second, 0.0, np.tile(MOST_MIXED * np.arange(1, n_partners + 1) / n_partners, n))[
            :, None
        ]
        mixed = (1.0 - share) * own[first] + share * own[second]
        mixed = within_worker(mixed / np.sqrt((1.0 - share) ** 2 + share**2), self.owner[first])
        lost = np.mean(own**2, axis=0) / np.maximum(np.mean(mixed**2, axis=0), 1e-18)
        return first, mixed * np.sqrt(lost)  # a worker's mean stays, and so does the variance

    def anyone(self, mean: np.ndarray, like: int | None = None) -> Law:
        """The law of somebody never seen with this mean (K,): deviations like those of one worker, or of all."""
        first, deviation = self.sources
        rows = np.arange(len(first)) if like is None else self.rows_of(like)
        weight = np.full(len(rows), 1.0 / len(rows))
        return Law(weight, deviation[rows], self.reach[first[rows]], self.noise, mean)

    def population(self, people: LowRankNormal, own: np.ndarray, sizes: np.ndarray) -> Law:
        """The law of one performance of a new person each time: who he is like, of which size, and what he does.

        people : noise between people, with their mean; own (A, W, K) how people like the recorded ones deviate, at
        ``sizes`` (A,)
        """
        first, every = self.sources
        parts = []
        n_workers, n_coordinates = own.shape[1:]
        for worker in range(n_workers):
            rows = self.rows_of(worker)
            mean = own[:, worker, None] + every[rows]
            reach = np.broadcast_to(self.reach[first[rows]], mean.shape[:2])
            size = np.broadcast_to(sizes[:, None], mean.shape[:2])
            weight = np.full(mean.shape[:2], 1.0 / (n_workers * reach.size))
            parts.append((weight.ravel(), mean.reshape(-1, n_coordinates), reach.ravel(), size.ravel()))
        weight, mean, reach, size = (np.concatenate(part) for part in zip(*parts))
        return Law(weight, mean, reach, self.noise, people.mean, people, size)

    def rows_of(self, worker: int) -> np.ndarray:
        """The components that somebody like this worker has: that worker's own, and others' where there are few."""
        owner = self.owner[self.sources[0]]
        own = np.flatnonzero(owner == worker)
        if len(own) >= FEWEST_OWN:
            return own
        others = np.flatnonzero(owner != worker)
        step = max(1, len(others) // (FEWEST_OWN - len(own)))
        return np.concatenate([own, others[worker % step :: step][: FEWEST_OWN - len(own)]])

    def known(self, number: int, shrunk_mean: np.ndarray) -> Law:
        """The law of a worker seen in training: his own repetitions, and a little of what others do."""
        first, deviation = self.sources
        own, n = self.owner[first] == number, len(first)
        base = BASE / (np.sum(self.owner == number) + BASE)
        weight = np.append(np.full(own.sum(), (1.0 - base) / own.sum()), np.full(n, base / n))
        mean = np.concatenate([self.means[number] - shrunk_mean + deviation[own], deviation])
        return Law(weight, mean, np.append(self.reach[first[own]], self.reach[first]), self.noise, shrunk_mean)


def less_told(rows: np.ndarray, tells: np.ndarray) -> np.ndarray:
    """Rows (R, K) of which only that is left beside the first C coordinates which these do not tell."""
    n = len(tells)
    return np.concatenate([rows[:, :n], rows[:, n:] - rows[:, :n] @ tells], axis=1)


def with_told(rows: np.ndarray, tells: np.ndarray) -> np.ndarray:
    """The way back from ``less_told``."""
    n = len(tells)
    return np.concatenate([rows[:, :n], rows[:, n:] + rows[:, :n] @ tells], axis=1)


def room(left: np.ndarray, variance: np.ndarray, at_most: float = 1.0) -> np.ndarray:
    """The factor by which deviations of this variance leave no more than ``left`` of it; its square ``at_most``."""
    return np.sqrt(np.minimum(np.maximum(left, 0.0) / np.maximum(variance, 1e-18), at_most))


def partners(owner: np.ndarray, apart: np.ndarray) -> np.ndarray:
    """(N, ``N_MIXED``) the nearest other recordings of one worker by distances (N, N); itself where none is left."""
    among = np.where(owner[:, None] == owner[None], apart, np.inf)
    np.fill_diagonal(among, np.inf)
    nearest = np.argsort(among, axis=1, kind="stable")[:, :N_MIXED]
    none = np.take_along_axis(among, nearest, axis=1) == np.inf
    found = np.where(none, np.arange(len(owner))[:, None], nearest)
    return np.pad(found, ((0, 0), (0, max(0, N_MIXED - found.shape[1]))), mode="edge")
