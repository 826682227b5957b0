"""Gaussian process classification of two classes: Laplace's approximation, its evidence and the evidence's gradient.

Source: Rasmussen & Williams (2006), sec. 3.4, alg. 3.1 (mode), 3.2 (prediction), 5.1 (evidence and gradient), with the
logistic likelihood.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.cyclic.hyper import Factorisations, Hyper, kernel

NEWTON_STEPS = 100
SETTLED = 1e-9


@dataclass(frozen=True, eq=False)
class Mode:
    """Where the posterior over the latent values is greatest, and what prediction and evidence need of it."""

    latent: np.ndarray
    """(n,) f at the points."""
    weight: np.ndarray
    """(n,) gradient of log p(class | f): the mean of the latent at x is k(x, points) @ weight."""
    root: np.ndarray
    """(n,) square root of the curvature W."""
    factor: np.ndarray
    """(n, n) lower Cholesky factor of I + W^1/2 K W^1/2."""
    log_evidence: float


def mode_of(
    covariance: np.ndarray, positive: np.ndarray, start: np.ndarray | None = None, count: Factorisations | None = None
) -> Mode:
    """Newton's way to the mode, for covariances (n, n) and classes (n,) bool, from ``start`` (n,) or from 0."""
    from scipy.linalg import cho_solve

    latent = np.zeros(len(positive)) if start is None else start
    best = -np.inf
    for _ in range(NEWTON_STEPS):
        share, root, factor = _curved(covariance, latent, count)
        target = root**2 * latent + positive - share
        pull = target - root * cho_solve((factor, True), root * (covariance @ target))
        latent = covariance @ pull
        value = float(-0.5 * pull @ latent + _log_share(latent, positive))
        if value - best < SETTLED:
            break
        best = value
    share, root, factor = _curved(covariance, latent, count)
    return Mode(latent, positive - share, root, factor, float(value - np.log(factor.diagonal()).sum()))


def log_evidence(
    hyper: Hyper, x: np.ndarray, positive: np.ndarray, start: np.ndarray, count: Factorisations | None = None
) -> tuple[float, np.ndarray, np.ndarray]:
    """log q(class | x), its gradient (p + 2,) by the logarithms of lengths, signal, noise (0: there is none), and f."""
    from scipy.linalg import solve_triangular

    covariance = kernel(x, x, hyper)
    mode = mode_of(covariance, positive, start, count)
    half = solve_triangular(mode.factor, np.diag(mode.root), lower=True)
    precision = half.T @ half
    across = half @ covariance
    share = _logistic(mode.latent)
    third = share * (1 - share) * (1 - 2 * share)
    bend = -0.5 * (covariance.diagonal() - np.sum(across * across, axis=0)) * third
    bend -= precision @ (covariance @ bend)
    scaled = x / hyper.length
    square = [covariance * (column[:, None] - column[None, :]) ** 2 for column in scaled.T]
    slopes = []
    for change in (*square, 2 * covariance):
        moved = change @ mode.weight
        slopes.append(0.5 * mode.weight @ moved - 0.5 * np.sum(precision * change) + bend @ moved)
    return mode.log_evidence, np.array([*slopes, 0.0]), mode.latent


def _curved(
    covariance: np.ndarray, latent: np.ndarray, count: Factorisations | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    from scipy.linalg import cholesky

    share = _logistic(latent)
    root = np.sqrt(share * (1 - share))
    inner = root[:, None] * covariance * root
    inner.flat[:: len(root) + 1] += 1.0
    if count is not None:
        count.add(len(root))
    return share, root, cholesky(inner, lower=True, overwrite_a=True)


def _logistic(latent: np.ndarray) -> np.ndarray:
    return np.asarray(0.5 + 0.5 * np.tanh(0.5 * latent))


def _log_share(latent: np.ndarray, positive: np.ndarray) -> float:
    return float(-np.logaddexp(0.0, np.where(positive, -latent, latent)).sum())
