"""Is it a body in metres? Its size against what people measure, and the unit in which it would fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

UNITS_M = {"millimetres": 0.001, "centimetres": 0.01, "inches": 0.0254, "decimetres": 0.1, "feet": 0.3048}
SHORTEST_M, USUAL_M, TALLEST_M = 0.6, 1.7, 2.6
N_FRAMES = 15
MOST_NAMED = 5


def size_m(positions_m: np.ndarray) -> float:
    """Between the two farthest of the joints (T, J, 3), median over frames; nan where nothing was seen."""
    frames = np.unique(np.linspace(0, len(positions_m) - 1, N_FRAMES).astype(int))
    positions = positions_m[frames]
    away = np.linalg.norm(positions[:, :, None] - positions[:, None], axis=-1)
    most = np.where(np.isfinite(away), away, 0.0).max(axis=(1, 2))
    return float(np.median(most[most > 0])) if np.any(most > 0) else float("nan")


def wrong_size(take: str, positions_m: np.ndarray, shortest_m: float = SHORTEST_M, tallest_m: float = TALLEST_M) -> str:
    """What speaks against the joints (T, J, 3) of a take: found, expected, the unit that fits; empty if nothing."""
    size = size_m(positions_m)
    if np.isfinite(size) and shortest_m <= size <= tallest_m:
        return ""
    expected = f"expected {shortest_m:g} to {tallest_m:g} m"
    if not np.isfinite(size):
        return f"take {take}: found no frame in which two joints are seen, {expected} between the farthest"
    fitting = {unit: size * metres for unit, metres in UNITS_M.items()}
    unit = min(fitting, key=lambda name: abs(np.log(fitting[name] / USUAL_M)))
    fits = shortest_m <= fitting[unit] <= tallest_m
    hint = f"; in {unit} it would be {fitting[unit]:.2f} m" if fits else ""
    return f"take {take}: found {size:.3g} m between the two farthest joints, {expected}{hint}"


def first_of(said: Sequence[str], n_takes: int) -> list[str]:
    """What is said of takes, of many the first five and how many more."""
    more = len(said) - MOST_NAMED
    return [*said[:MOST_NAMED], *([f"and {more} more takes of {n_takes}"] if more > 0 else [])]
