"""Variance between and within workers: one-way random effects, unequal repetitions, and the intraclass correlation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.model.joint_coordinates import within_worker


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

    def reliability(self, counts: np.ndarray, share: np.ndarray | float = 1.0) -> np.ndarray:
        """(W, K) share of a worker's mean that is the worker and not the luck of ``counts`` (W,) repetitions.

        share : (K,) of the between-worker variance that is left to tell, once his body has told the rest
        """
        between = self.between * share
        noise = self.within_square / counts[:, None]
        return np.where(between > 0, between / np.maximum(between + noise, 1e-300), 0.0)


def anova(values: np.ndarray, worker_index: np.ndarray, df_lost: np.ndarray | int = 0) -> Anova:
    """Mean squares of values (N, K) between and within workers; all zero between where there is one worker.

    df_lost : (K,) degrees of freedom between workers that went with the means of kinds of workers
    Source: Searle, Casella & McCulloch, Variance Components, sec. 3.6 (unbalanced one-way, moment estimator).
    """
    counts = np.bincount(worker_index)
    counts = counts[counts > 0]
    n, w = len(values), len(counts)
    residual = within_worker(values, worker_index)
    explained = values - residual - values.mean(axis=0)
    size = (n - np.sum(counts**2) / n) / (w - 1) if w > 1 else 1.0
    within = np.sum(residual**2, axis=0) / max(n - w, 1)
    between = np.sum(explained**2, axis=0) / (w - 1 - df_lost) if w > 1 else np.zeros(values.shape[1])
    return Anova(between, within, float(size), w - 1, n - w)


def intraclass_correlation(values: np.ndarray, worker_index: np.ndarray, confidence: float = 0.95) -> tuple[float, ...]:
    """ICC(1) of values (N,) with its interval: (icc, low, high); three NaN without two workers and repeats.

    The interval takes unweighted means of workers and the harmonic mean of their repetitions: the F interval of
    Shrout & Fleiss where all have equally many. Of 2, 2, 2, 2, 20 and 20 repetitions 95 % covered 0.92 at ICC 0, 0.936
    at 0.2 and 0.95 above (4,000 sets each); the icc itself, by other weights, lay outside in at most 1.4 % of them.
    Sources: Shrout & Fleiss (1979), ICC(1,1), with n0 for the number of repetitions; Thomas & Hultquist (1978).
    """
    from scipy.special import fdtri

    parts = anova(values[:, None], worker_index)
    if parts.df_between < 1 or parts.df_within < 1 or parts.within_square[0] <= 0:
        return (float("nan"),) * 3
    square, size = _of_unweighted_means(values, worker_index)
    ratio = square / float(parts.within_square[0])
    tail = (1 + confidence) / 2
    low = ratio / fdtri(parts.df_between, parts.df_within, tail)
    high = ratio * fdtri(parts.df_within, parts.df_between, tail)
    told = float(parts.between_square[0] / parts.within_square[0])
    return tuple(float((f - 1) / (f + n - 1)) for f, n in ((told, parts.size), (low, size), (high, size)))


def _of_unweighted_means(values: np.ndarray, worker_index: np.ndarray) -> tuple[float, float]:
    """Mean square between workers who count alike, and the harmonic mean of their repetitions, which it is times."""
    counts = np.bincount(worker_index)
    there = counts > 0
    means = np.bincount(worker_index, values)[there] / counts[there]
    size = float(np.sum(there) / np.sum(1.0 / counts[there]))
    return size * float(means.var(ddof=1)), size
