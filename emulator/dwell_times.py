"""Times of performances that pause: whole time from moving time and dwells, its moments, and the way back.

whole = moving + sum of dwells. Without sites of pauses (``len(model.dwells) == 0``) none of this is called.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from emulator.warp import evaluate

if TYPE_CHECKING:
    from emulator.model import MotionEmulator
    from emulator.workforce import WorkerEffect

GRID = np.linspace(-8.5, 8.5, 2001)
WEIGHTS = np.exp(-0.5 * GRID**2) / np.exp(-0.5 * GRID**2).sum()
_N_HERMITE = 20


def whole_s(model: MotionEmulator, scores: np.ndarray) -> np.ndarray:
    """(n,) seconds, pauses included."""
    return np.asarray(model.moving_s(scores) + model.dwell_s(scores).sum(axis=-1))


def mark_share(model: MotionEmulator, scores: np.ndarray, moving_share: np.ndarray) -> np.ndarray:
    """(n, E) share of the whole time at marks that fall at ``moving_share`` (n, E) of the moving time."""
    moving_s, dwell_s = model.moving_s(scores)[:, None], model.dwell_s(scores)
    at_s = moving_s * moving_share + dwell_s @ model.dwells.mark_share.T
    return np.asarray(at_s / (moving_s + dwell_s.sum(axis=-1, keepdims=True)))


def moving_share(model: MotionEmulator, scores: np.ndarray, own_share: np.ndarray) -> np.ndarray:
    """(n, T) share of the moving time at shares (n, T) of the whole time: it stands still while a pause lasts."""
    moving_s, dwell_s = model.moving_s(scores)[:, None], model.dwell_s(scores)
    time_s = np.array(own_share * (moving_s + dwell_s.sum(axis=-1, keepdims=True)))
    start_s = moving_s * evaluate(model.warps(scores), model.dwells.clock)
    for j in range(dwell_s.shape[1]):  # each pause is taken out of the time that is left: later ones start earlier
        time_s -= np.clip(time_s - start_s[:, j : j + 1], 0.0, dwell_s[:, j : j + 1])
    return np.asarray(time_s / moving_s)


def moments_s(model: MotionEmulator, effect: WorkerEffect | None) -> tuple[float, float]:
    """Mean and standard deviation of the whole time, of one worker or (None) over the population.

    Products of different terms by Mehler's series in Hermite polynomials of normal X, Y with correlation rho:
    Cov(f(X), g(Y)) = sum over k >= 1 of rho^k f_k g_k.
    """
    law, at = model.workforce.law(effect), coordinates_of_times(model)
    mean, covariance = law.coordinates(at)
    scale = model.scale.spread[at]
    parts = [
        _moments_s(model, model.scale.centre[at] + scale * m, c * np.outer(scale, scale))
        for m, c in zip(mean, covariance)
    ]
    means, variances = np.array(parts).T
    mean_s = law.weight @ means
    return float(mean_s), float(np.sqrt(law.weight @ (variances + (means - mean_s) ** 2)))


def _moments_s(model: MotionEmulator, mean: np.ndarray, covariance: np.ndarray) -> tuple[float, float]:
    """Mean and variance of the whole time where the raw coordinates (1 + S,) are normal."""
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    moving_s = np.exp(model.margin.inverse(mean[0] + spread[0] * GRID))
    latent = mean[1:] + spread[1:] * GRID[:, None]
    terms = np.concatenate([moving_s[None], model.dwells.seconds(latent).T])
    coefficients = (terms * WEIGHTS) @ _hermite().T
    correlation = np.clip(covariance / np.outer(spread, spread), -1.0, 1.0)
    power, product = np.ones_like(correlation), np.zeros_like(correlation)
    for k in range(1, _N_HERMITE):
        power = power * correlation
        product += power * np.outer(coefficients[:, k], coefficients[:, k])
    np.fill_diagonal(product, terms**2 @ WEIGHTS - coefficients[:, 0] ** 2)
    return float(coefficients[:, 0].sum()), max(float(product.sum()), 0.0)


def coordinates_of_times(model: MotionEmulator) -> np.ndarray:
    """Where duration and dwells lie in z: (1 + S,)."""
    return np.r_[model.scale.block("duration"), model.scale.block("dwells")]


def _hermite() -> np.ndarray:
    """(K, G) Hermite polynomials on the grid, orthonormal under the standard normal."""
    rows = [np.ones_like(GRID), GRID]
    for k in range(1, _N_HERMITE - 1):
        rows.append((GRID * rows[k] - np.sqrt(k) * rows[k - 1]) / np.sqrt(k + 1.0))
    return np.stack(rows)
