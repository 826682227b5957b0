"""Hyper-parameters of a Gaussian process: the log marginal likelihood, its gradient, and where it is greatest.

Kernel: signal^2 exp(-1/2 sum_p (x_p - x'_p)^2 / length_p^2) + noise^2 for a point with itself.
Source: Rasmussen & Williams (2006), eq. 2.31 (kernel), 2.30 and 5.9 (likelihood and gradient, alg. 2.1); the outputs
share one kernel as in Remillard & Kry (2010): log p = sum over d of log N(y_d; 0, K).

Gaussian process regression, exact: several outputs that share one kernel, predicted with their variance.

Source: Rasmussen & Williams (2006), alg. 2.1; the shared kernel as in Remillard & Kry (2010), sec. 2.

A Gaussian process through a few of its points: what a step costs then goes with their number, not with the data's.

The points are chosen by a pivoted Cholesky factorisation until what it leaves out is a small share of the noise; mean
and variance are then those of all data seen through these points.
Source: projected process approximation, Rasmussen & Williams (2006), sec. 8.3.4; pivots as in Fine & Scheinberg (2001).
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


THINNED = 160
"""Hyper-parameters are sought on this many points first; on all of them they then need a few steps only."""


@dataclass(frozen=True, eq=False)
class GaussianProcess:
    """Outputs y (n, d) at inputs x (n, p), zero mean, one kernel for all d; output d is ``scale[d]`` times unit."""

    x: np.ndarray
    y: np.ndarray
    scale: np.ndarray
    hyper: Hyper
    factor: np.ndarray
    """(n, n) lower Cholesky factor of the kernel with noise."""
    alpha: np.ndarray
    """(n, d) K^-1 y of the outputs at unit scale."""
    log_likelihood: float
    """log p(y | x), in the units of y."""
    count: Factorisations

    @classmethod
    def fit(
        cls, x: np.ndarray, y: np.ndarray, *, hyper: Hyper | None = None, start: Hyper | None = None, at_most: int = 12
    ) -> GaussianProcess:
        """Hyper-parameters by marginal likelihood, or those given (for outputs at unit spread).

        x : (n, p), y : (n, d); a search takes at most ``at_most`` factorisations of size n, and, unless it has a
        ``start``, 60 of size THINNED before.
        Raises ValueError for shapes that disagree, fewer than 2 points, and numbers that are not finite.
        """
        x, y = _checked(x, y)
        scale = np.maximum(np.sqrt(np.mean(y * y, axis=0)), 1e-12)
        count = Factorisations({})
        if hyper is None:
            thin = np.unique(np.linspace(0, len(x) - 1, THINNED).round().astype(int))
            if start is None and len(x) > 1.25 * THINNED:
                start = fitted_hyper(x[thin], y[thin] / scale, at_most=60, count=count)
            hyper = fitted_hyper(x, y / scale, start=start, at_most=at_most if len(x) > THINNED else 60, count=count)
        return cls.of(x, y, scale, hyper, count)

    @classmethod
    def of(
        cls, x: np.ndarray, y: np.ndarray, scale: np.ndarray, hyper: Hyper, count: Factorisations
    ) -> GaussianProcess:
        """The process with these hyper-parameters: one factorisation. Raises ValueError for a singular kernel."""
        from scipy.linalg import LinAlgError, cho_solve, cholesky

        noisy = kernel(x, x, hyper)
        noisy.flat[:: len(x) + 1] += hyper.noise**2
        count.add(len(x))
        try:
            factor = cholesky(noisy, lower=True, overwrite_a=True)
        except LinAlgError:
            raise ValueError(
                f"the kernel of {len(x)} points is singular: two inputs are the same and noise is {hyper.noise:.3g}"
            ) from None
        unit = y / scale
        alpha = cho_solve((factor, True), unit)
        n, d = y.shape
        value = -0.5 * np.sum(unit * alpha) - d * np.log(factor.diagonal()).sum() - 0.5 * n * d * np.log(2 * np.pi)
        return cls(x, y, scale, hyper, factor, alpha, float(value - n * np.log(scale).sum()), count)

    def predict(self, x: np.ndarray, *, noise: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Mean and variance (m, d) of the outputs at x (m, p); with ``noise``, of a new observation there."""
        from scipy.linalg import solve_triangular

        across = kernel(self.x, np.asarray(x, float), self.hyper)
        half = solve_triangular(self.factor, across, lower=True)
        variance = np.maximum(self.hyper.signal**2 - np.sum(half * half, axis=0), 0.0)
        variance = variance + self.hyper.noise**2 * noise
        return (across.T @ self.alpha) * self.scale, variance[:, None] * self.scale**2

    @property
    def n_factorisations(self) -> float:
        """Cost of the fit in Cholesky factorisations of all its points."""
        return self.count.as_of(len(self.x))


def gradient_of(process: GaussianProcess) -> np.ndarray:
    """(p + 2,) gradient of the log likelihood where the process stands: about 0 after a full search."""
    return log_likelihood(process.hyper, process.x, process.y / process.scale)[1]


def _checked(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.atleast_2d(np.asarray(x, float)), np.asarray(y, float)
    y = y[:, None] if y.ndim == 1 else y
    if len(x) != len(y) or len(x) < 2:
        raise ValueError(
            f"a Gaussian process needs as many outputs as inputs, two at least; found {len(y)} and {len(x)}"
        )
    if not (np.all(np.isfinite(x)) and np.all(np.isfinite(y))):
        raise ValueError("a Gaussian process needs finite inputs and outputs; found nan or infinity")
    return x, y


LEFT_OUT = 1e-3
"""Greatest variance left out at a training point, as a share of the noise variance."""


@dataclass(frozen=True, eq=False)
class Projected:
    """``points`` (m, p), ``weight`` (m, d), ``shrink`` (m, m), ``scale`` (d,), ``hyper`` as in the process."""

    points: np.ndarray
    hyper: Hyper
    weight: np.ndarray
    shrink: np.ndarray
    scale: np.ndarray

    @classmethod
    def of(cls, process: GaussianProcess, left_out: float = LEFT_OUT) -> Projected:
        from scipy.linalg import cho_factor, cho_solve, solve_triangular

        hyper = process.hyper
        pivots, low = pivoted(process.x, hyper, left_out * hyper.noise**2)
        lower = low[:, pivots].T
        identity = np.eye(len(pivots))
        inverse = solve_triangular(lower, identity, lower=True)
        inner = cho_factor(hyper.noise**2 * identity + low @ low.T, lower=True)
        weight = inverse.T @ cho_solve(inner, low @ (process.y / process.scale))
        shrink = inverse.T @ (identity - hyper.noise**2 * cho_solve(inner, identity)) @ inverse
        return cls(process.x[pivots], hyper, weight * process.scale, shrink, process.scale)

    def predict(self, x: np.ndarray, *, noise: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Mean and variance (m, d) at x (m, p), as ``GaussianProcess.predict``."""
        across = kernel(np.asarray(x, float), self.points, self.hyper)
        variance = np.maximum(self.hyper.signal**2 - np.sum((across @ self.shrink) * across, axis=1), 0.0)
        variance = variance + self.hyper.noise**2 * noise
        return across @ self.weight, variance[:, None] * self.scale**2


def pivoted(x: np.ndarray, hyper: Hyper, left_out: float) -> tuple[np.ndarray, np.ndarray]:
    """Numbers (m,) of points, and L (m, n) with L'L = kernel(x, x) but for at most ``left_out`` on the diagonal."""
    left = np.full(len(x), hyper.signal**2)
    rows: list[np.ndarray] = []
    pivots: list[int] = []
    while len(pivots) < len(x) and left.max() > left_out:
        at = int(left.argmax())
        row = kernel(x[at : at + 1], x, hyper)[0]
        for earlier in rows:
            row -= earlier[at] * earlier
        row /= np.sqrt(left[at])
        row[pivots] = 0.0
        left = np.maximum(left - row * row, 0.0)
        left[[*pivots, at]] = 0.0
        rows.append(row)
        pivots.append(at)
    return np.array(pivots), np.array(rows)
