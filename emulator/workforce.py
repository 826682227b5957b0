"""Who performs: between-worker and within-worker parts of the joint coordinates, z = u_worker + e."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from emulator.density import LowRankNormal
from emulator.law import Law
from emulator.margin import within_worker
from emulator.smoothed import SmoothedScores

BETWEEN_METHOD = (
    "variances by ANOVA (a negative one is 0); correlations of people's means, shrunk to 0 by rho = {rho}; "
    "a known worker's mean is shrunk coordinate by coordinate by its reliability"
)


def shrinkages(n_sequences: int, n_workers: int) -> tuple[float, float]:
    """rho of the correlations between workers and within: 1.2 / W and 4 / (N - W), at most 0.2 and 0.1.

    Largest for few people, gone for many: a fixed rho would weaken the bond of posture and duration for ever.
    """
    return min(0.2, 1.2 / n_workers), min(0.1, 4.0 / max(n_sequences - n_workers, 1))


@dataclass(frozen=True)
class WorkerEffect:
    """What makes one worker this worker: z (K,) joint coordinates, and the worker's name (empty if drawn).

    ``scale`` multiplies every bone length; it is 1 unless a body height was asked for.
    """

    z: np.ndarray
    name: str = ""
    scale: float = 1.0


@dataclass(frozen=True)
class Workforce:
    """Between-worker Gaussian of u, within-worker Gaussian of e, and the people seen in training.

    between, within : LowRankNormal over K coordinates (within has mean 0)
    names : W worker names; effects : (W, K) their shrunk means
    smoothed : the repetitions themselves, blurred, in place of the Gaussian ``within``; None for plain Gaussians
    """

    between: LowRankNormal
    within: LowRankNormal
    names: tuple[str, ...]
    effects: np.ndarray
    smoothed: SmoothedScores | None = None

    @classmethod
    def fit(
        cls, z: np.ndarray, worker_index: np.ndarray, names: tuple[str, ...], rho_between: float, rho_within: float
    ) -> Workforce:
        """Moment (ANOVA) estimates from z (N, K) and worker_index (N,) into ``names`` (each with a repetition)."""
        parts = anova(z, worker_index)
        means = np.stack([z[worker_index == w].mean(axis=0) for w in range(len(names))])
        centre = means.mean(axis=0)
        residual_df = max(len(z) - len(names), 1)
        within = LowRankNormal.of_rows(
            np.zeros(z.shape[1]), within_worker(z, worker_index) / np.sqrt(residual_df), rho_within
        )
        between = LowRankNormal.of_rows(centre, _between_rows(means - centre, parts.between), rho_between)
        effects = centre + parts.reliability(np.bincount(worker_index)) * (means - centre)
        return cls(between, within, names, effects)

    @property
    def has_worker_effect(self) -> bool:
        return len(self.names) > 1

    def law(self, effect: WorkerEffect | None) -> Law:
        """The law of z of the worker with this effect, or (None) of a new worker each time."""
        people = self.between if effect is None else None
        mean = np.zeros_like(self.between.mean) if effect is None else effect.z
        if self.smoothed is None:
            return Law(np.ones(1), np.zeros((1, len(mean))), np.ones(1), self.within, mean, people)
        if effect is not None and effect.name in self.names:
            return self._known_laws[self.names.index(effect.name)]
        return self.smoothed.anyone(mean, people)

    @cached_property
    def _known_laws(self) -> tuple[Law, ...]:
        assert self.smoothed is not None
        return tuple(self.smoothed.known(w, effect) for w, effect in enumerate(self.effects))


@dataclass(frozen=True)
class Anova:
    """One-way random-effects analysis of K coordinates: mean squares and variance components, each (K,).

    ``size`` is the effective number of repetitions a worker, n0 = (N - sum n_w^2 / N) / (W - 1).
    """

    between_square: np.ndarray
    within_square: np.ndarray
    size: float
    df_between: int
    df_within: int

    @property
    def between(self) -> np.ndarray:
        """(K,) between-worker variances, not below 0."""
        return np.maximum((self.between_square - self.within_square) / self.size, 0.0)

    def reliability(self, counts: np.ndarray) -> np.ndarray:
        """(W, K) share of a worker's mean that is the worker and not the luck of ``counts`` (W,) repetitions."""
        between = self.between
        noise = self.within_square / counts[:, None]
        return np.where(between > 0, between / np.maximum(between + noise, 1e-300), 0.0)


def anova(values: np.ndarray, worker_index: np.ndarray) -> Anova:
    """Mean squares of values (N, K) between and within workers; all zero between where there is one worker.

    Source: Searle, Casella & McCulloch, Variance Components, sec. 3.6 (unbalanced one-way, moment estimator).
    """
    counts = np.bincount(worker_index)
    counts = counts[counts > 0]
    n, w = len(values), len(counts)
    residual = within_worker(values, worker_index)
    explained = values - residual - values.mean(axis=0)
    size = (n - np.sum(counts**2) / n) / (w - 1) if w > 1 else 1.0
    within = np.sum(residual**2, axis=0) / max(n - w, 1)
    between = np.sum(explained**2, axis=0) / (w - 1) if w > 1 else np.zeros(values.shape[1])
    return Anova(between, within, float(size), w - 1, n - w)


def intraclass_correlation(values: np.ndarray, worker_index: np.ndarray, confidence: float = 0.95) -> tuple[float, ...]:
    """ICC(1) of values (N,), with the exact F interval: (icc, low, high); three NaN without two workers and repeats.

    Source: Shrout & Fleiss (1979), ICC(1,1) and its interval, with n0 for the number of repetitions.
    """
    from scipy.special import fdtri

    parts = anova(values[:, None], worker_index)
    if parts.df_between < 1 or parts.df_within < 1 or parts.within_square[0] <= 0:
        return (float("nan"),) * 3
    ratio = float(parts.between_square[0] / parts.within_square[0])
    tail = (1 + confidence) / 2
    low = ratio / fdtri(parts.df_between, parts.df_within, tail)
    high = ratio * fdtri(parts.df_within, parts.df_between, tail)
    return tuple(float((f - 1) / (f + parts.size - 1)) for f in (ratio, low, high))


def _between_rows(deviations: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """Rows (W, K) whose product has the given variances (K,) and the correlations of the people's means."""
    if len(deviations) < 2:
        return np.zeros_like(deviations)
    spread = np.sqrt(np.sum(deviations**2, axis=0))
    return deviations * np.where(spread > 0, np.sqrt(variance) / np.where(spread > 0, spread, 1.0), 0.0)
