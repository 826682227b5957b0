"""Performances under a condition: a given duration, a shift of log duration (fatigue), a pace.

Those that pause are drawn near the duration, then moved the rest of the way by regression.
"""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any

import numpy as np

from emulator.model.dwell_times import GRID, WEIGHTS
from emulator.model.gaussian import Law, regression
from emulator.model.joint_law import JointLaw
from emulator.people.workers import WorkerEffect

EXPECTED = {"duration_s": "positive seconds", "log_duration_shift": "a finite number", "pace": "a positive ratio"}
CONDITIONS = tuple(EXPECTED)
POOL = 64
"""Free draws for each one of a task with pauses that is given a duration."""


def given(
    model: JointLaw,
    law: Law,
    n: int,
    rng: np.random.Generator,
    effect: WorkerEffect | None,
    condition: Mapping[str, Any],
) -> np.ndarray:
    """z (n, K) under a condition: drawn given the duration, then moved along its regression on the duration.

    Raises ValueError for an unknown condition, or a duration or pace that is not positive.
    """
    asked = _checked(condition)
    if len(model.dwells):
        return _paused(model, law, n, rng, effect, asked)
    at = model.scale.block("duration").start
    if "duration_s" in asked:
        z = law.sample(n, rng, given=(at, model.duration_z(np.log(np.broadcast_to(asked["duration_s"], n)))))
    else:
        z = law.sample(n, rng)
    return shifted(model, z, model.covariance_with(at, effect), asked.get("log_duration_shift", 0.0))


def shifted(model: JointLaw, z: np.ndarray, column: np.ndarray, shift: float | np.ndarray) -> np.ndarray:
    """z (n, K) with log duration moved by ``shift``, the rest by its regression: ``column`` (K,) of covariances."""
    at = model.scale.block("duration").start
    log_duration = model.margin.inverse(model.scale.raw(z, "duration")[:, 0])
    step = model.duration_z(log_duration + np.asarray(shift)) - z[:, at]
    moved = z + step[:, None] * regression(column, at)
    return np.where(np.broadcast_to(shift, len(z))[:, None] == 0, z, moved)  # no shift: the same bits


def _checked(condition: Mapping[str, Any]) -> dict[str, Any]:
    """The condition with a pace as the shift that it is."""
    if not isinstance(condition, Mapping):
        raise ValueError(f"condition: found {condition!r}, expected a mapping such as {{'duration_s': 2.5}}")
    wrong = []
    for name, value in condition.items():
        if name not in CONDITIONS:
            near = get_close_matches(str(name), CONDITIONS, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(CONDITIONS)}"
            wrong.append(f"condition: no {name!r}; {hint}")
        elif (
            np.asarray(value).dtype.kind not in "iuf"
            or not np.all(np.isfinite(value))
            or (name != "log_duration_shift" and not np.all(np.asarray(value) > 0))
        ):
            expected = EXPECTED[name]
            wrong.append(f"condition: {name}: found {value}, expected {expected}")
    if wrong:
        raise ValueError("\n".join(wrong))
    asked = dict(condition)
    if "pace" in asked:
        asked["log_duration_shift"] = asked.get("log_duration_shift", 0.0) - np.log(asked.pop("pace"))
    return asked


def _paused(
    model: JointLaw,
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
    at = model.coordinates_of_times()
    slope = _gradient_s(model, effect) * model.scale.spread[at]
    direction = np.sum([g * model.covariance_with(i, effect) for g, i in zip(slope, at.tolist())], axis=0)
    given_s = condition["duration_s"] if "duration_s" in condition else model.whole_s(z)
    shift = np.broadcast_to(condition.get("log_duration_shift", 0.0), n)
    moved = _lasting(model, z, direction, given_s * np.exp(shift))
    return moved if "duration_s" in condition else np.where(shift[:, None] == 0, z, moved)  # no shift: the same bits


def _near(model: JointLaw, law: Law, n: int, rng: np.random.Generator, duration_s: Any) -> np.ndarray:
    """Draws (n, K) that last nearly ``duration_s`` (number or (n,)), no draw twice for one and the same duration."""
    target_s = np.broadcast_to(np.asarray(duration_s, float), n)
    if not np.all(np.isfinite(target_s) & (target_s > 0)):
        raise ValueError(f"duration_s: found {duration_s}, expected positive seconds")
    pool = law.sample(POOL * n, rng)
    lasting_s = model.whole_s(pool)
    order = np.argsort(lasting_s, kind="stable")
    place = np.searchsorted(lasting_s[order], target_s) - n // 2 + rng.permutation(n)
    return np.asarray(pool[order[np.clip(place, 0, POOL * n - 1)]])


def _coordinates(model: JointLaw, effect: WorkerEffect | None) -> tuple[np.ndarray, np.ndarray]:
    """Mean (1 + S,) and covariance of the raw coordinates of duration and dwells."""
    at, spread = model.coordinates_of_times(), model.scale.spread[model.coordinates_of_times()]
    mean = model.workforce.between.mean if effect is None else effect.z
    covariance = np.stack([model.covariance_with(i, effect)[at] for i in at.tolist()])
    return model.scale.centre[at] + spread * mean[at], covariance * np.outer(spread, spread)


def _gradient_s(model: JointLaw, effect: WorkerEffect | None) -> np.ndarray:
    """(1 + S,) how the mean whole time rises with the mean of each raw coordinate of duration and dwells."""
    mean, covariance = _coordinates(model, effect)
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    step = np.maximum(1e-3 * spread, 1e-9)
    around = [mean[0] + sign * step[0] + spread[0] * GRID for sign in (1, -1)]
    moving = [np.exp(model.margin.inverse(coordinate)) @ WEIGHTS for coordinate in around]
    dwell = [model.dwells.mean_s(mean[1:] + sign * step[1:], spread[1:]) for sign in (1, -1)]
    return np.append(moving[0] - moving[1], dwell[0] - dwell[1]) / (2 * step)


def _lasting(model: JointLaw, z: np.ndarray, direction: np.ndarray, target_s: np.ndarray) -> np.ndarray:
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
        long = model.whole_s(z + middle[:, None] * rising) > target_s
        low, high = np.where(long, low, middle), np.where(long, middle, high)
    moved = z + low[:, None] * rising
    moving_s = target_s - model.dwell_s(moved).sum(axis=-1)  # what rounding left goes to the moving time
    raw = model.margin.forward(np.log(moving_s))
    moved[:, at] = (raw - model.scale.centre[at]) / model.scale.spread[at]
    return moved


def _bracket(model: JointLaw, z: np.ndarray, rising: np.ndarray, target_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Steps (n,) below and above which the whole time is short and long enough; both 0 where it is right."""
    excess = model.whole_s(z) - target_s
    right = np.abs(excess) <= 1e-13 * target_s
    low, high = np.where(excess > 0, -1.0, 0.0), np.where(excess < 0, 1.0, 0.0)
    for _ in range(40):
        short = model.whole_s(z + low[:, None] * rising) <= target_s
        long = model.whole_s(z + high[:, None] * rising) >= target_s
        if np.all(short | right) and np.all(long | right):
            break
        low, high = np.where(short, low, 2 * low), np.where(long, high, 2 * high)
    return np.where(right, 0.0, low), np.where(right, 0.0, high)
