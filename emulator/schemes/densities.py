"""The paper's statistical models: MVG, IG and Kernel of one coefficient vector a sequence, VAR of scores over time.

The start posture is part of the vector. Kernel is a smoothed bootstrap that keeps mean and covariance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import floor, log10
from typing import Protocol

import numpy as np

from emulator.model.gaussian import LowRankNormal

PAPER_ORDER = 12
"""Source: Chen, Park & Srivastava sec. 4.3.2."""


@dataclass(frozen=True)
class VAR:
    """y_t = intercept + sum of lags_k y_(t - k) + noise.

    lags    : (p, d, d); intercept : (d,); noise : Gaussian about 0 with the residuals' covariance
    opening : law of the first p points (p d,): of the one sequence as they are, of pooled sequences a Gaussian
    start   : Gaussian of the start posture's scores
    sequence: number of the training sequence it was fitted to, or None for all of them together
    """

    intercept: np.ndarray
    lags: np.ndarray
    noise: LowRankNormal
    opening: LowRankNormal
    start: LowRankNormal
    n_times: int
    sequence: int | None

    @classmethod
    def fit(
        cls,
        scores: np.ndarray,
        start: np.ndarray,
        rng: np.random.Generator,
        *,
        pooled: bool,
        order: int | None = None,
    ) -> VAR:
        """Least squares on one sequence of scores (N, T, d) chosen at random, as in the paper, or on all of them.

        order : p; None for 12, or the largest that T points of one sequence can tell.
        Raises ValueError for an order that leaves no residual.
        """
        sequence = None if pooled else int(rng.integers(len(scores)))
        chosen = scores if sequence is None else scores[sequence][None]
        n_seen, n_times, d = chosen.shape
        p = _order(order, n_seen, n_times, d)
        before, now = _lagged(chosen, p)
        n_before = before.shape[1]
        stacked = np.concatenate([before, now], axis=1)
        r = np.asarray(np.linalg.qr(stacked, mode="r"))  # neighbouring lags are too alike to square
        coefficients = np.linalg.lstsq(r[:n_before, :n_before], r[:n_before, n_before:], rcond=None)[0]
        residual = (now - before @ coefficients) / np.sqrt(len(now) - n_before)
        windows = chosen[:, :p].reshape(n_seen, p * d)
        middle = windows.mean(axis=0)
        return cls(
            coefficients[0],
            np.swapaxes(coefficients[1:].reshape(p, d, d), 1, 2),
            LowRankNormal.of_rows(np.zeros(d), residual, 0.0),
            LowRankNormal.of_rows(middle, (windows - middle) / np.sqrt(max(n_seen - 1, 1)), 0.0),
            LowRankNormal.fit(start, 0.0),
            n_times,
            sequence,
        )

    @property
    def order(self) -> int:
        return len(self.lags)

    @property
    def modulus(self) -> float:
        """The largest modulus of the companion matrix's eigenvalues; from 1 on, sequences explode."""
        p, d = self.lags.shape[:2]
        companion = np.eye(p * d, k=-d)
        companion[:d] = np.moveaxis(self.lags, 0, 1).reshape(d, p * d)
        return float(np.abs(np.linalg.eigvals(companion)).max())

    def sample(
        self, n: int, rng: np.random.Generator, *, allow_unstable: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """n scores (n, T, d) and start scores (n, S); first the openings, then the noise, then the starts.

        Raises ValueError where the model explodes (companion modulus from 1 on), unless ``allow_unstable``.
        """
        if not allow_unstable and self.modulus >= 1:
            calmer = "a lower order" if self.sequence is None else "VAR-pooled or a lower order"
            raise ValueError(
                f"VAR({self.order}): its companion modulus is {_beside_one(self.modulus)}, from 1 on sequences "
                f"explode; fit {calmer}, or in Python ask with allow_unstable=True"
            )
        p, d = self.lags.shape[:2]
        scores = np.empty((n, self.n_times, d))
        scores[:, :p] = self.opening.sample(n, rng).reshape(n, p, d)
        scores[:, p:] = self.intercept + self.noise.sample(n * (self.n_times - p), rng).reshape(n, -1, d)
        newest_last = np.swapaxes(self.lags[::-1], 1, 2).reshape(p * d, d)
        with np.errstate(over="ignore", invalid="ignore"):
            for t in range(p, self.n_times):
                scores[:, t] += scores[:, t - p : t].reshape(n, p * d) @ newest_last
        if not np.isfinite(scores).all():
            found = f"its companion modulus is {_beside_one(self.modulus)}"
            raise ValueError(f"VAR({p}): exploded beyond all numbers; {found}")
        return scores, self.start.sample(n, rng)

    def log_likelihood(self, scores: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Log density (...,) of scores (..., T, d) given their first p points, and of the start posture."""
        p, d = self.lags.shape[:2]
        sequences = scores.reshape(-1, *scores.shape[-2:])
        before, now = _lagged(sequences, p)
        error = now - before @ np.concatenate([self.intercept[None], np.swapaxes(self.lags, 1, 2).reshape(p * d, d)])
        inner = self.noise.log_likelihood(error).reshape(len(sequences), -1).sum(axis=1)
        return np.asarray(inner.reshape(scores.shape[:-2]) + self.start.log_likelihood(start))


def _beside_one(modulus: float) -> str:
    """With four decimals, or as many more as it takes to see on which side of 1 it lies; 1 itself is "1"."""
    apart = abs(modulus - 1.0)
    if apart == 0 or apart > 100:
        return f"{modulus:g}"
    return f"{modulus:.{max(4, -floor(log10(apart)))}f}"


def _lagged(sequences: np.ndarray, p: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows (1, y_(t - 1), ..., y_(t - p)) and y_t, of all sequences (n, T, d), one after the other."""
    n_times, d = sequences.shape[1:]
    before = [np.ones((len(sequences), n_times - p, 1))]
    before += [sequences[:, p - k : n_times - k] for k in range(1, p + 1)]
    return np.concatenate(before, axis=-1).reshape(-1, 1 + p * d), sequences[:, p:].reshape(-1, d)


def _order(order: int | None, n: int, n_times: int, d: int) -> int:
    """The order asked for, or 12 where n sequences of T points leave residuals of d scores."""
    largest = max((p for p in range(1, n_times) if n * (n_times - p) - 1 - p * d >= d), default=0)
    if order is None and largest:
        return min(PAPER_ORDER, largest)
    if order is None or order != int(order) or not 1 <= order <= largest:
        asked = "VAR" if order is None else f"VAR({order})"
        raise ValueError(f"{asked}: {n} x {n_times} points of {d} scores can tell an order from 1 to {largest}")
    return int(order)


QUARTILES = (0.25, 0.5, 0.75)
N_TRIED, N_HALVINGS = 400, 20


@dataclass(frozen=True)
class KernelDensity:
    """x = mean + sqrt(1 - share) (a training row - mean), scaled to their covariance, + sqrt(share) noise.

    rows  : (N, K) training coefficients, so scaled that draws have their covariance whatever the share
    noise : the training covariance about 0; share : in [0, 1]; 0 copies, 1 is the MVG
    Source: Silverman & Young (1987); the share by distances to what is left out, see ``fit``.
    """

    mean: np.ndarray
    rows: np.ndarray
    noise: LowRankNormal
    share: float

    @classmethod
    def fit(cls, coefficients: np.ndarray, share: float | None = None) -> KernelDensity:
        """Fit to (N, K), N >= 3; without ``share`` the largest with draws no further from the training than it should.

        No further: the quartiles of the distance from a draw to the nearest row, against those from a row to the
        nearest other one, in the geometric mean. That is what an unseen sequence would be.
        """
        if len(coefficients) < 3:
            raise ValueError(f"a kernel density needs at least 3 sequences, found {len(coefficients)}")
        whole = LowRankNormal.fit(coefficients, rho=0.0)
        noise = LowRankNormal(np.zeros(len(whole.mean)), whole.factor, whole.spread, 0.0)
        rows = (coefficients - whole.mean) * np.sqrt(len(coefficients) / (len(coefficients) - 1))
        return cls(whole.mean, rows, noise, _share(coefficients, whole.mean, rows, noise) if share is None else share)

    def sample(self, n: int, rng: np.random.Generator) -> np.ndarray:
        """n draws (n, K); first the rows, then the noise."""
        at = rng.integers(len(self.rows), size=n)
        return np.asarray(self._at(self.share, at, self.noise.sample(n, rng)))

    def _at(self, share: float, at: np.ndarray, noise: np.ndarray) -> np.ndarray:
        return self.mean + np.sqrt(1.0 - share) * self.rows[at] + np.sqrt(share) * noise

    def log_likelihood(self, coefficients: np.ndarray) -> np.ndarray:
        """Log density (...,) of coefficients (..., K) in the span of the training; -inf beside the rows at share 0."""
        _, size, basis = np.linalg.svd(self.noise.factor, full_matrices=False)
        kept = size > size.max(initial=0.0) * 1e-5
        if self.share == 0:
            return np.full(coefficients.shape[:-1], -np.inf)
        white = (basis[kept] / size[kept, None]).T
        x = (coefficients - self.mean) @ white / np.sqrt(self.share)
        rows = np.sqrt((1.0 - self.share) / self.share) * self.rows @ white
        square = np.sum(x**2, -1)[..., None] + np.sum(rows**2, -1) - 2 * x @ rows.T
        log_volume = 0.5 * kept.sum() * np.log(2 * np.pi * self.share) + np.log(size[kept]).sum()
        nearest = square.min(axis=-1)
        mixed = np.log(np.mean(np.exp(-0.5 * (square - nearest[..., None])), axis=-1))
        return np.asarray(mixed - 0.5 * nearest - log_volume)


def _share(coefficients: np.ndarray, mean: np.ndarray, rows: np.ndarray, noise: LowRankNormal) -> float:
    """By bisection, always with the same random numbers."""
    rng = np.random.default_rng(0)
    at, drawn = np.arange(N_TRIED) % len(rows), noise.sample(N_TRIED, rng)
    asked = _quartiles(_squares(coefficients, coefficients) + np.diag(np.full(len(rows), np.inf)))
    tried, low, high = KernelDensity(mean, rows, noise, 0.0), 0.0, 1.0
    for _ in range(N_HALVINGS):
        middle = (low + high) / 2
        reached = _quartiles(_squares(tried._at(middle, at, drawn), coefficients))
        low, high = (low, middle) if np.mean(reached - asked) > 0 else (middle, high)
    return high if high == 1.0 else low


def _squares(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.sum(a**2, -1)[:, None] + np.sum(b**2, -1) - 2 * a @ b.T


def _quartiles(square: np.ndarray) -> np.ndarray:
    """(3,) logarithms of the quartiles of the distance to the nearest."""
    return np.asarray(np.log(np.maximum(np.quantile(np.sqrt(np.maximum(square.min(axis=1), 0.0)), QUARTILES), 1e-12)))


class Density(Protocol):
    def sample(self, n: int, rng: np.random.Generator) -> np.ndarray: ...
    def log_likelihood(self, scores: np.ndarray) -> np.ndarray: ...


DENSITIES: dict[str, Callable[[np.ndarray, float], Density]] = {
    "MVG": LowRankNormal.fit,
    "IG": lambda rows, _: LowRankNormal.fit(rows, 1.0),
    "Kernel": lambda rows, _: KernelDensity.fit(rows),
}
"""Name -> the density fitted to rows (N, K), of which a share of the correlations is given up (by the MVG alone)."""


@dataclass(frozen=True)
class VectorModel:
    """One density of scores (n, K) and start scores (n, S) side by side.

    MVG draws them together, so that alpha(0) goes with what follows; IG draws every number by itself.
    Source: Chen, Park & Srivastava sec. 4.3.1; it does not say how alpha(0) is drawn.
    """

    density: Density
    n_scores: int

    @classmethod
    def fit(cls, name: str, scores: np.ndarray, start: np.ndarray, rho: float = 0.0) -> VectorModel:
        """The density of this name in ``DENSITIES`` of scores (N, K) and start (N, S); ``rho`` as there."""
        return cls(DENSITIES[name](np.concatenate([scores, start], axis=-1), rho), scores.shape[-1])

    def sample(
        self, n: int, rng: np.random.Generator, *, allow_unstable: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """n scores (n, K) and start scores (n, S)."""
        rows = self.density.sample(n, rng)
        return rows[:, : self.n_scores], rows[:, self.n_scores :]

    def log_likelihood(self, scores: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Log density (...,) of both together, in the subspace of the training."""
        return self.density.log_likelihood(np.concatenate([scores, start], axis=-1))
