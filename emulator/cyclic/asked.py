"""What is asked of cyclic performances: how far, how often or how long, and how fast. Checked, all mistakes at once."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.cyclic.crew import CyclicWorker
from emulator.cyclic.pace import FASTEST_M_PER_S, SLOWEST_M_PER_S, Asked

if TYPE_CHECKING:
    from emulator.cyclic.model import CyclicEmulator

LIMITS = {
    "distance_m": (0.05, 100_000.0, "metres from 0.05"),
    "cycles": (1.0, 1_000_000.0, "a whole number from 1"),
    "length_s": (0.2, 1_000_000.0, "seconds from 0.2"),
    "speed_m_per_s": (
        SLOWEST_M_PER_S,
        FASTEST_M_PER_S,
        f"{SLOWEST_M_PER_S:g} to {FASTEST_M_PER_S:g} m/s, as people walk",
    ),
    "pace": (0.05, 20.0, "a positive ratio"),
    "log_duration_shift": (-3.0, 3.0, "a number from -3 to 3"),
}
CONDITIONS = tuple(LIMITS)
LENGTHS = CONDITIONS[:3]
_TOGETHER_M_PER_S = (0.05, 4.0)
_WALKED = ("distance_m", "speed_m_per_s")


def asked_of(model: CyclicEmulator, condition: Any, n: int, leg_m: np.ndarray, who: CyclicWorker) -> Asked:
    """The condition for n performances of these workers. Raises ValueError with every mistake in it."""
    said = _checked(model.task, condition, n, model.pace.steps)
    if not set(said) & set(LENGTHS):
        said["distance_m" if model.pace.steps else "cycles"] = np.full(n, model.pace.default)
    quicker = said.get("pace", np.ones(n)) * np.exp(-said.get("log_duration_shift", np.zeros(n)))
    nowhere = np.full(n, np.nan)
    if not model.pace.steps:
        return Asked(said.get("cycles", nowhere), who.pace * quicker, said.get("length_s", nowhere), nowhere)
    own = who.pace * model.pace.usual_m_per_s(leg_m)
    speed = np.clip(said.get("speed_m_per_s", own) * quicker, SLOWEST_M_PER_S, FASTEST_M_PER_S)
    total_s, beats = said.get("length_s", nowhere), 2 * said["cycles"] if "cycles" in said else nowhere
    if "distance_m" in said:
        way_m = said["distance_m"]
        speed = way_m / total_s if "length_s" in said else speed
    elif "cycles" in said:
        gone = beats + model.pace.halves
        way_m = gone * model.pace.step_m(speed * (beats + model.pace.beyond) / gone, leg_m, who.log_step)
    else:
        way_m = speed * total_s
    return Asked(way_m, speed, total_s, beats)


def _checked(task: str, condition: Any, n: int, steps: bool) -> dict[str, np.ndarray]:
    """The condition as arrays (n,)."""
    if condition is None:
        return {}
    if not isinstance(condition, Mapping):
        raise ValueError(f"{task}: condition: found {condition!r}, expected a mapping such as {{'distance_m': 3.0}}")
    wrong, said = [], {}
    for name, value in condition.items():
        if name not in CONDITIONS:
            near = get_close_matches(str(name), CONDITIONS, n=1)
            wrong.append(
                f"no {name!r}; " + (f"did you mean {near[0]!r}?" if near else f"known: {', '.join(CONDITIONS)}")
            )
        elif name in _WALKED and not steps:
            wrong.append(f"{name}: found {value}, but nobody walks in this task; expected cycles or length_s")
        elif problem := _out_of(name, value, n):
            wrong.append(problem)
        else:
            said[name] = np.broadcast_to(np.asarray(value, float), n).astype(float)
    wrong += _together(said)
    if wrong:
        raise ValueError("\n".join(f"{task}: condition: {line}" for line in wrong))
    return said


def _out_of(name: str, value: Any, n: int) -> str:
    low, high, expected = LIMITS[name]
    array = np.asarray(value)
    if array.dtype.kind not in "iuf" or array.shape not in ((), (n,)):
        return f"{name}: found {value!r}, expected {expected} (one number, or {n})"
    inside = np.isfinite(array) & (array >= low) & (array <= high)
    if name == "cycles":
        inside = inside & (array == np.rint(array))
    if np.all(inside):
        return ""
    return f"{name}: found {np.atleast_1d(array)[~np.atleast_1d(inside)][0]:g}, expected {expected}"


def _together(said: Mapping[str, np.ndarray]) -> list[str]:
    """How long it is may be said once; a distance and a time together are a speed."""
    lengths = [name for name in LENGTHS if name in said]
    if set(lengths) == {"distance_m", "length_s"}:
        speed = said["distance_m"] / said["length_s"]
        low, high = _TOGETHER_M_PER_S
        if "speed_m_per_s" in said:
            return ["found distance_m, length_s and speed_m_per_s, expected two of them"]
        if np.any((speed < low) | (speed > high)):
            return [
                f"distance_m over length_s: found {speed.min():g} to {speed.max():g} m/s, expected {low:g} to {high:g}"
            ]
        return []
    return [f"found {' and '.join(lengths)}, expected one of them"] if len(lengths) > 1 else []
