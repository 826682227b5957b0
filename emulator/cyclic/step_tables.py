"""What the compiled step reads: projected processes of all states and the borders between them, padded to one size."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from emulator.cyclic.classifier import StateClassifier
from emulator.cyclic.hyper import Hyper
from emulator.cyclic.projected import Projected, pivoted
from emulator.cyclic.support import Support

BORDER_LEFT_OUT = 1e-4
"""Share of the signal's variance that a border seen through a few of its points may leave out."""


def tables_of(
    processes: Sequence[Projected], keeps: bool, classifier: StateClassifier, support: Support
) -> dict[str, np.ndarray]:
    """The fields of ``emulator.kernels.switching.Tables`` by name."""
    borders = [_border(process.x, process.hyper, process.mode.weight) for process in classifier.processes]
    n_inputs = processes[0].points.shape[1]
    return {
        "points": _padded([one.points / one.hyper.length for one in processes]),
        "per_length": np.array([1 / one.hyper.length for one in processes]),
        "used": np.array([len(one.points) for one in processes]),
        "variance": np.array([one.hyper.signal**2 for one in processes]),
        "noise": np.array([one.hyper.noise**2 for one in processes]),
        "weight": _padded([one.weight * one.hyper.signal**2 for one in processes]),
        "shrink": _padded([one.shrink * one.hyper.signal**4 for one in processes], square=True),
        "scale": np.array([one.scale**2 for one in processes]),
        "keep": np.full(len(processes), float(keeps)),
        "border_points": _padded([points for points, _, _ in borders]) if borders else np.empty((0, 0, n_inputs)),
        "border_per_length": np.array([per_length for _, per_length, _ in borders]).reshape(-1, n_inputs),
        "border_used": np.array([len(points) for points, _, _ in borders], dtype=np.int64),
        "border_weight": _padded([weight for _, _, weight in borders]) if borders else np.empty((0, 0)),
        "support": support.points,
        "ways": support.ways,
        "leading": np.array(support.leading),
        "reach": np.array(support.radius + np.linalg.norm(support.ways, axis=1).max()),
        "radius2": np.array(support.radius**2),
    }


def kernel_tables(arrays: dict[str, np.ndarray]) -> Any:
    """The named tuple that the kernel takes."""
    from emulator.kernels.switching import Tables

    numbers: dict[str, Any] = {name: arrays[name].item() for name in ("leading", "reach", "radius2")}
    rows: dict[str, Any] = {name: np.ascontiguousarray(arrays[name]) for name in Tables._fields if name not in numbers}
    rows |= {name: np.ascontiguousarray(rows[name].swapaxes(1, 2)) for name in ("points", "border_points")}
    return Tables(**rows, **numbers)


def _border(x: np.ndarray, hyper: Hyper, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Scaled points (m, p), 1 / lengths and weights (m,) of a classifying process seen through its pivots."""
    from scipy.linalg import solve_triangular

    pivots, low = pivoted(x, hyper, BORDER_LEFT_OUT * hyper.signal**2)
    through = solve_triangular(low[:, pivots], low @ weight)
    return x[pivots] / hyper.length, 1 / hyper.length, through * hyper.signal**2


def _padded(arrays: Sequence[np.ndarray], square: bool = False) -> np.ndarray:
    """(S, M, ...) of arrays (m, ...) with zeros below, and, if ``square``, to the right."""
    most = max(len(array) for array in arrays)
    out = np.zeros((len(arrays), most, *([most] if square else arrays[0].shape[1:])))
    for place, array in zip(out, arrays):
        place[tuple(slice(0, n) for n in array.shape)] = array
    return out
