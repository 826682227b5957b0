"""Switching dynamics as a library keeps them: the tables a step reads, without the support of the recordings.

A cyclic emulator bounds its draws beat by beat (``guide.py``), so that no step has to look through all recorded frames.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from emulator.cyclic.switching import SwitchingDynamics

FAR = 1e30
"""Distance, or its square, that nothing has."""
COUNTED = ("used", "border_used")
KEPT = ("points", "per_length", *COUNTED[:1], "variance", "noise", "weight", "scale", "keep")
BORDERS = ("border_points", "border_per_length", COUNTED[1], "border_weight")
MOST_POINTS = 2000


def unbounded(dynamics: SwitchingDynamics) -> SwitchingDynamics:
    """The same processes; a step may go anywhere."""
    return replace(dynamics, tables=dynamics.tables | _nowhere(dynamics.n_latents))


def _nowhere(d: int) -> dict[str, np.ndarray]:
    """Tables of a support of one point that holds everything."""
    one = np.zeros((1, d))
    return {"support": one, "ways": one, "leading": np.array(1), "reach": np.array(FAR), "radius2": np.array(FAR)}


def dynamics_arrays(dynamics: SwitchingDynamics) -> dict[str, np.ndarray]:
    """What a library keeps; of the symmetric shrinkage the lower triangle."""
    tables = dynamics.tables
    rows, columns = np.tril_indices(tables["points"].shape[1])
    arrays = {name: tables[name] for name in (*KEPT, *BORDERS)}
    counts = {name: tables[name].astype(np.int32) for name in COUNTED}
    return arrays | counts | {"shrink": tables["shrink"][:, rows, columns], "states": dynamics.states.astype(np.int32)}


def dynamics_of(task: str, arrays: Mapping[str, np.ndarray]) -> SwitchingDynamics:
    """The way back. Raises ValueError for tables that do not fit each other: compiled code reads them unchecked."""
    n_states, n_points, n_inputs = _shape(task, arrays["points"], 3)
    d = _shape(task, arrays["weight"], 3)[2]
    n_borders, n_border_points, _ = _shape(task, arrays["border_points"], 3)
    if not (1 <= n_states <= 16 and 1 <= n_points <= MOST_POINTS and 1 <= d <= n_inputs and n_borders <= 16):
        raise ValueError(f"{task}: dynamics of {n_states} states, {n_points} points and {d} latents make no sense")
    expected = {
        "points": (n_states, n_points, n_inputs), "per_length": (n_states, n_inputs), "used": (n_states,),
        "variance": (n_states,), "noise": (n_states,), "weight": (n_states, n_points, d), "scale": (n_states, d),
        "keep": (n_states,), "border_points": (n_borders, n_border_points, n_inputs),
        "border_per_length": (n_borders, n_inputs), "border_used": (n_borders,),
        "border_weight": (n_borders, n_border_points), "states": (n_states,),
        "shrink": (n_states, n_points * (n_points + 1) // 2),
    }  # fmt: skip
    for name, shape in expected.items():
        if arrays[name].shape != shape:
            raise ValueError(f"{task}/dynamics_{name} has shape {arrays[name].shape}, expected {shape}")
    _counted(task, arrays, "used", n_points)
    _counted(task, arrays, "border_used", n_border_points)
    if n_borders != (n_states if n_states > 2 else n_states - 1):
        raise ValueError(f"{task}: {n_borders} borders between {n_states} states")
    if any(np.any(arrays[name] < 0) for name in ("variance", "noise", "scale")):
        raise ValueError(f"{task}: a variance of its dynamics is negative")
    tables = {name: np.ascontiguousarray(arrays[name]) for name in (*KEPT, *BORDERS)}
    tables |= {name: arrays[name].astype(np.int64) for name in COUNTED}
    return SwitchingDynamics(
        arrays["states"].astype(int),
        tables | {"shrink": _square(arrays["shrink"], n_points)} | _nowhere(d),
        np.zeros((0, d)),
        FAR,
    )


def _square(lower: np.ndarray, n: int) -> np.ndarray:
    rows, columns = np.tril_indices(n)
    whole = np.zeros((len(lower), n, n))
    whole[:, rows, columns] = lower
    whole[:, columns, rows] = lower
    return whole


def _shape(task: str, array: np.ndarray, n_axes: int) -> tuple[int, ...]:
    if array.ndim != n_axes:
        raise ValueError(f"{task}: dynamics with an array of shape {array.shape}, expected {n_axes} axes")
    return array.shape


def _counted(task: str, arrays: Mapping[str, np.ndarray], name: str, most: int) -> None:
    found = arrays[name]
    if found.dtype.kind not in "iu" or np.any((found < 1) | (found > most)):
        raise ValueError(f"{task}/dynamics_{name}: found {found.tolist()}, expected whole numbers from 1 to {most}")
