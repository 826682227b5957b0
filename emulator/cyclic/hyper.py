"""Hyper-parameters of a Gaussian process: the log marginal likelihood, its gradient, and where it is greatest.

Kernel: signal^2 exp(-1/2 sum_p (x_p - x'_p)^2 / length_p^2) + noise^2 for a point with itself.
Source: Rasmussen & Williams (2006), eq. 2.31 (kernel), 2.30 and 5.9 (likelihood and gradient, alg. 2.1); the outputs
share one kernel as in Remillard & Kry (2010): log p = sum over d of log N(y_d; 0, K).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

LENGTH_BOUNDS = (0.02, 50.0)
SIGNAL_BOUNDS = (0.05, 20.0)
NOISE_BOUNDS = (1e-3, 2.0)


@dataclass(frozen=True, eq=False)
class Hyper:
    """``length`` (p,) of each input, ``signal`` and ``noise`` as standard deviations; ValueError if not positive."""

    length: np.ndarray
    signal: float
    noise: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "length", np.atleast_1d(np.asarray(self.length, float)))
        found = self.logs
        if not np.all(np.isfinite(found)):
            raise ValueError(f"lengths, signal and noise must be positive and finite, found {np.exp(found)}")

    @property
    def logs(self) -> np.ndarray:
        """(p + 2,) logarithms: lengths, signal, noise."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.log(np.array([*self.length, self.signal, self.noise]))

    @classmethod
    def from_logs(cls, logs: np.ndarray) -> Hyper:
        *length, signal, noise = np.exp(logs).tolist()
        return cls(np.array(length), signal, noise)


def start_of(x: np.ndarray) -> Hyper:
    """Where a search begins: each length as wide as the input's spread, a tenth of the signal is noise."""
    spread = np.asarray(x, float).std(axis=0)
    return Hyper(np.clip(np.where(spread > 0, spread, 1.0), *LENGTH_BOUNDS), 1.0, 0.1)


def kernel(x: np.ndarray, other: np.ndarray, hyper: Hyper) -> np.ndarray:
    """Covariances (n, m) of the points x (n, p) and other (m, p), without noise."""
    a, b = np.asarray(x, float) / hyper.length, np.asarray(other, float) / hyper.length
    square = (a * a).sum(1)[:, None] + (b * b).sum(1)[None, :] - 2 * a @ b.T
    return np.asarray(hyper.signal**2 * np.exp(-0.5 * np.maximum(square, 0.0, out=square), out=square))


@dataclass
class Factorisations:
    """How many Cholesky factorisations were made, by the size of the matrix."""

    of_size: dict[int, int]

    def add(self, n: int) -> None:
        self.of_size[n] = self.of_size.get(n, 0) + 1

    def as_of(self, n: int) -> float:
        """Their cost as a number of factorisations of size n (the cost goes with the third power)."""
        return sum(times * (size / n) ** 3 for size, times in self.of_size.items())


def log_likelihood(
    hyper: Hyper, x: np.ndarray, y: np.ndarray, count: Factorisations | None = None
) -> tuple[float, np.ndarray]:
    """log p(y | x) for y (n, d), and its gradient (p + 2,) by the logarithms of lengths, signal and noise."""
    from scipy.linalg import lapack

    n, d = y.shape
    clean = kernel(x, x, hyper)
    noisy = clean.copy()
    noisy.flat[:: n + 1] += hyper.noise**2
    factor, failed = lapack.dpotrf(noisy, lower=1, overwrite_a=1)
    if count is not None:
        count.add(n)
    if failed:
        return -np.inf, np.zeros(len(hyper.length) + 2)
    alpha = lapack.dpotrs(factor, y, lower=1)[0]
    value = -0.5 * np.sum(y * alpha) - d * np.log(factor.diagonal()).sum() - 0.5 * n * d * np.log(2 * np.pi)
    inverse = lapack.dpotri(factor, lower=1, overwrite_c=1)[0]
    return float(value), _gradient(hyper, x, clean, alpha, inverse)


def _gradient(hyper: Hyper, x: np.ndarray, clean: np.ndarray, alpha: np.ndarray, inverse: np.ndarray) -> np.ndarray:
    """1/2 tr((alpha alpha' - d K^-1) dK); squares of differences are taken apart, so that p costs next to nothing.

    inverse : (n, n), of which only the lower triangle is right, as LAPACK leaves it
    """
    d = alpha.shape[1]
    weight = np.tril(alpha @ alpha.T - d * inverse)
    weight.flat[:: len(x) + 1] *= 0.5
    noise = 2 * hyper.noise**2 * np.trace(weight)
    weight *= clean
    signal = 2 * weight.sum()
    rows = weight.sum(0) + weight.sum(1)
    scaled = x / hyper.length
    square = rows @ scaled**2 - 2 * np.sum(scaled * (weight @ scaled), axis=0)
    return np.array([*square, signal, noise])


def fitted_hyper(
    x: np.ndarray,
    y: np.ndarray,
    *,
    start: Hyper | None = None,
    at_most: int = 40,
    count: Factorisations | None = None,
) -> Hyper:
    """The hyper-parameters at which log p(y | x) is greatest near ``start``; at most ``at_most`` factorisations.

    By L-BFGS-B within LENGTH_BOUNDS, SIGNAL_BOUNDS and NOISE_BOUNDS (x and y at about unit spread).
    """
    return Hyper.from_logs(
        greatest(lambda logs: log_likelihood(Hyper.from_logs(logs), x, y, count), start or start_of(x), at_most)
    )


def greatest(
    value_and_gradient: Callable[[np.ndarray], tuple[float, np.ndarray]], start: Hyper, at_most: int
) -> np.ndarray:
    """Logarithms at which a function of them is greatest, after at most ``at_most`` of its evaluations."""
    from scipy.optimize import minimize

    best: list[tuple[float, np.ndarray]] = [(-np.inf, start.logs)]

    def down(logs: np.ndarray) -> tuple[float, np.ndarray]:
        if len(best) > at_most:
            raise StopIteration
        value, gradient = value_and_gradient(logs)
        best.append((value, logs.copy()))
        return (-value, -gradient) if np.isfinite(value) else (1e12, np.zeros_like(gradient))

    limits = [*(LENGTH_BOUNDS,) * len(start.length), SIGNAL_BOUNDS, NOISE_BOUNDS]
    bounds = [tuple(np.log(pair)) for pair in limits]
    with suppress(StopIteration):
        minimize(down, start.logs, jac=True, method="L-BFGS-B", bounds=bounds, options={"ftol": 1e-7})
    return max(best, key=lambda found: found[0])[1]
