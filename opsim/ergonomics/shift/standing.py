"""Somebody who stands upright with hanging arms: what waiting is taken for, where the scenario says so."""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.columns import ANGLES, AT, COLUMNS

_LENGTHS_M = {
    "elbow_above_m": -0.30,
    "across_m": -0.20,
    "outside_m": 0.0,
    "hand_up_m": 0.75,
    "ankle_up_m": 0.05,
}
"""Of each side, of somebody 1.75 m tall; source: design. No score changes within a hand's breadth of them."""


def _standing() -> np.ndarray:
    found = np.full(len(COLUMNS), np.nan, np.float32)
    found[: len(ANGLES)] = 0.0
    for name, length_m in _LENGTHS_M.items():
        found[[AT[f"left_{name}"], AT[f"right_{name}"]]] = length_m
    found[[AT["hands_forward_m"], AT["hands_left_m"]]] = 0.0
    found[AT["pelvis_up_m"]] = 0.95
    return found


STANDING = _standing()
"""(COLUMNS,) measures; every angle is 0."""
