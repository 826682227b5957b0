"""Performances under a condition: a given duration, a shift of log duration (fatigue), a pace."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.model import dwell_times
from emulator.model.gaussian import regression

if TYPE_CHECKING:
    from emulator.model.emulator import MotionEmulator
    from emulator.model.gaussian import Law
    from emulator.people.workers import WorkerEffect

EXPECTED = {"duration_s": "positive seconds", "log_duration_shift": "a finite number", "pace": "a positive ratio"}
CONDITIONS = tuple(EXPECTED)


def given(
    model: MotionEmulator,
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
        return dwell_times.conditioned(model, law, n, rng, effect, asked)
    at = model.scale.block("duration").start
    if "duration_s" in asked:
        z = law.sample(n, rng, given=(at, model.duration_z(np.log(np.broadcast_to(asked["duration_s"], n)))))
    else:
        z = law.sample(n, rng)
    return shifted(model, z, model.covariance_with(at, effect), asked.get("log_duration_shift", 0.0))


def shifted(model: MotionEmulator, z: np.ndarray, column: np.ndarray, shift: float | np.ndarray) -> np.ndarray:
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
