"""A Gaussian process through a few of its points: what a step costs then goes with their number, not with the data's.

The points are chosen by a pivoted Cholesky factorisation until what it leaves out is a small share of the noise; mean
and variance are then those of all data seen through these points.
Source: projected process approximation, Rasmussen & Williams (2006), sec. 8.3.4; pivots as in Fine & Scheinberg (2001).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.cyclic.gp import GaussianProcess
from emulator.cyclic.hyper import Hyper, kernel

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
