"""Dwell times: how long a performance pauses at each site of the common clock, as coordinates of the joint vector.

A site is a place of the common clock where repetitions hold. Its coordinate is a latent normal number: below a
threshold there is no pause (the share of repetitions without one), above it the dwell is lognormal, or by normal
scores where that is refused. The duration block then models the MOVING time, and a performance lasts its moving time
plus its dwells. Shares of the whole duration would tie the pause to the pace: with pauses of 1 s in 40 % of reaches
of 1.6 s they drew moving times of CV 0.20 where 0.16 is true; seconds drew 0.16.
Source: a tobit (Tobin 1958): a normal coordinate of which only the part above a threshold is seen.

Times of performances that pause: whole time from moving time and dwells, its moments, and the way back.

whole = moving + sum of dwells. Without sites of pauses (``len(model.dwells) == 0``) none of this is called.

Performances that pause, given how long they last: drawn near it, then moved the rest of the way by regression.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.geometry.warps import evaluate
from emulator.model.joint_coordinates import Margin

if TYPE_CHECKING:
    from emulator.model.emulator import MotionEmulator
    from emulator.model.gaussian import Law
    from emulator.people.workers import WorkerEffect

_GRID = np.linspace(-8.5, 8.5, 2001)
_WEIGHTS = np.exp(-0.5 * _GRID**2) / np.exp(-0.5 * _GRID**2).sum()


@dataclass(frozen=True)
class Dwells:
    """Sites of pauses and the law of each dwell; without sites nothing ever pauses.

    clock      : (S,) places on the common clock, increasing
    zero_share : (S,) share of repetitions that do not pause there
    margins    : S margins of log dwell, given that there is a pause
    mark_share : (E, S) share of the pause that has passed at a mark
    """

    clock: np.ndarray
    zero_share: np.ndarray
    margins: tuple[Margin, ...]
    mark_share: np.ndarray

    def __len__(self) -> int:
        return len(self.clock)

    def seconds(self, latent: np.ndarray) -> np.ndarray:
        """Dwells (n, S) of latent coordinates (n, S)."""
        columns = [self._column(j, latent[..., j]) for j in range(len(self))]
        return np.stack(columns, axis=-1) if columns else np.zeros((len(latent), 0))

    def mean_s(self, mean: np.ndarray, spread: np.ndarray) -> np.ndarray:
        """Mean dwells (S,) where the latent coordinates are normal with these means and standard deviations (S,)."""
        return np.array([self._column(j, mean[j] + spread[j] * _GRID) @ _WEIGHTS for j in range(len(self))])

    def _column(self, j: int, latent: np.ndarray) -> np.ndarray:
        from scipy.special import ndtr, ndtri

        tail = ndtr(-latent) / (1.0 - self.zero_share[j])  # from above: 1 - share of pauses that are shorter
        pauses = tail < 1.0
        given = -ndtri(np.where(pauses, np.maximum(tail, 1e-300), 0.5))
        return np.where(pauses, np.exp(self.margins[j].inverse(given)), 0.0)


NONE = Dwells(np.zeros(0), np.zeros(0), (), np.zeros((0, 0)))


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


POOL = 64
"""Free draws for each one that is given a duration."""


def conditioned(
    model: MotionEmulator,
    law: Law,
    n: int,
    rng: np.random.Generator,
    effect: WorkerEffect | None,
    condition: Mapping[str, Any],
) -> np.ndarray:
    """z (n, K) under a condition on the whole time.

    A given duration: those of ``POOL`` n draws that last nearly so long, each moved the rest of the way. A shift of log
    duration: the draw itself, moved. The way is the regression of z on the whole time, noise kept.
    """
    z = _near(model, law, n, rng, condition["duration_s"]) if "duration_s" in condition else law.sample(n, rng)
    at = coordinates_of_times(model)
    slope = _gradient_s(model, effect) * model.scale.spread[at]
    direction = np.sum([g * model.covariance_with(i, effect) for g, i in zip(slope, at.tolist())], axis=0)
    given_s = condition["duration_s"] if "duration_s" in condition else whole_s(model, z)
    shift = np.broadcast_to(condition.get("log_duration_shift", 0.0), n)
    moved = _lasting(model, z, direction, given_s * np.exp(shift))
    return moved if "duration_s" in condition else np.where(shift[:, None] == 0, z, moved)  # no shift: the same bits


def _near(model: MotionEmulator, law: Law, n: int, rng: np.random.Generator, duration_s: Any) -> np.ndarray:
    """Draws (n, K) that last nearly ``duration_s`` (number or (n,)), no draw twice for one and the same duration."""
    target_s = np.broadcast_to(np.asarray(duration_s, float), n)
    if not np.all(np.isfinite(target_s) & (target_s > 0)):
        raise ValueError(f"duration_s: found {duration_s}, expected positive seconds")
    pool = law.sample(POOL * n, rng)
    lasting_s = whole_s(model, pool)
    order = np.argsort(lasting_s, kind="stable")
    place = np.searchsorted(lasting_s[order], target_s) - n // 2 + rng.permutation(n)
    return np.asarray(pool[order[np.clip(place, 0, POOL * n - 1)]])


def _coordinates(model: MotionEmulator, effect: WorkerEffect | None) -> tuple[np.ndarray, np.ndarray]:
    """Mean (1 + S,) and covariance of the raw coordinates of duration and dwells."""
    at, spread = coordinates_of_times(model), model.scale.spread[coordinates_of_times(model)]
    mean = model.workforce.between.mean if effect is None else effect.z
    covariance = np.stack([model.covariance_with(i, effect)[at] for i in at.tolist()])
    return model.scale.centre[at] + spread * mean[at], covariance * np.outer(spread, spread)


def _gradient_s(model: MotionEmulator, effect: WorkerEffect | None) -> np.ndarray:
    """(1 + S,) how the mean whole time rises with the mean of each raw coordinate of duration and dwells."""
    mean, covariance = _coordinates(model, effect)
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    step = np.maximum(1e-3 * spread, 1e-9)
    around = [mean[0] + sign * step[0] + spread[0] * GRID for sign in (1, -1)]
    moving = [np.exp(model.margin.inverse(coordinate)) @ WEIGHTS for coordinate in around]
    dwell = [model.dwells.mean_s(mean[1:] + sign * step[1:], spread[1:]) for sign in (1, -1)]
    return np.append(moving[0] - moving[1], dwell[0] - dwell[1]) / (2 * step)


def _lasting(model: MotionEmulator, z: np.ndarray, direction: np.ndarray, target_s: np.ndarray) -> np.ndarray:
    """z (n, K) moved along ``direction`` (K,) until the whole time is ``target_s`` (n,), by bisection.

    The direction is the regression of z on the whole time; its parts on duration and dwells are kept from falling, so
    that the time rises along it. Coordinates that last as long as asked for already are not moved.
    """
    at, sites = model.scale.block("duration").start, model.scale.block("dwells")
    rising = direction.copy()
    rising[sites] = np.maximum(rising[sites], 0.0)
    rising[at] = max(rising[at], 0.1 * float(np.abs(rising[sites]).max()), 1e-9)
    rising = rising / rising[at]
    low, high = _bracket(model, z, rising, target_s)
    for _ in range(60):
        middle = (low + high) / 2
        long = whole_s(model, z + middle[:, None] * rising) > target_s
        low, high = np.where(long, low, middle), np.where(long, middle, high)
    moved = z + low[:, None] * rising
    moving_s = target_s - model.dwell_s(moved).sum(axis=-1)  # what rounding left goes to the moving time
    raw = model.margin.forward(np.log(moving_s))
    moved[:, at] = (raw - model.scale.centre[at]) / model.scale.spread[at]
    return moved


def _bracket(
    model: MotionEmulator, z: np.ndarray, rising: np.ndarray, target_s: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Steps (n,) below and above which the whole time is short and long enough; both 0 where it is right."""
    excess = whole_s(model, z) - target_s
    right = np.abs(excess) <= 1e-13 * target_s
    low, high = np.where(excess > 0, -1.0, 0.0), np.where(excess < 0, 1.0, 0.0)
    for _ in range(40):
        short = whole_s(model, z + low[:, None] * rising) <= target_s
        long = whole_s(model, z + high[:, None] * rising) >= target_s
        if np.all(short | right) and np.all(long | right):
            break
        low, high = np.where(short, low, 2 * low), np.where(long, high, 2 * high)
    return np.where(right, 0.0, low), np.where(right, 0.0, high)
