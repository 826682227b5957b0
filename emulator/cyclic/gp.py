"""Gaussian process regression, exact: several outputs that share one kernel, predicted with their variance.

Source: Rasmussen & Williams (2006), alg. 2.1; the shared kernel as in Remillard & Kry (2010), sec. 2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.cyclic.hyper import Factorisations, Hyper, fitted_hyper, kernel, log_likelihood

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
