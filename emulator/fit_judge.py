"""What the posture components lose of repetitions that had no part in them: a figure of the fit report."""

from __future__ import annotations

import numpy as np

from emulator import sphere
from emulator.flatten import SIEM
from emulator.reduce import JointPCA


def reconstruction_deg(flatten: SIEM, directions: np.ndarray, n_components: int, n_folds: int = 5) -> float:
    """Mean angle (degrees a bone) between aligned repetitions (N, T, B, 3) and their projection on others' components.

    Folds are every ``n_folds``-th repetition, so that in each some repetitions of every worker are left in.
    """
    flat = flatten.forward(directions).reshape(len(directions), -1)
    folds = np.arange(len(flat)) % min(n_folds, len(flat))
    angles = []
    for fold in np.unique(folds):
        held = folds == fold
        rank = int(np.sum(~held)) - 1
        if rank < 1:
            return float("nan")
        pca = JointPCA.fit(flat[~held], 0.999999, min(n_components, rank))
        again = flatten.inverse(pca.inverse(pca.forward(flat[held])).reshape(-1, *flatten_shape(directions)))
        angles.append(sphere.angle(again, directions[held]).mean(axis=(1, 2)))
    return float(np.degrees(np.concatenate(angles).mean()))


def flatten_shape(directions: np.ndarray) -> tuple[int, int]:
    """(T, 2B) of directions (N, T, B, 3)."""
    return directions.shape[1], 2 * directions.shape[2]
