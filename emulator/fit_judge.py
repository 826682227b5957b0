"""What the fit report says of the repetitions: what the posture components lose of them, and which are strangers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from emulator import sphere
from emulator.flatten import SIEM
from emulator.reduce import JointPCA

STRANGE, FEWEST_TO_JUDGE = 6.0, 6
"""Of 263 correct public repetitions one lies this many times as far from the nearest other as they usually do."""


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


def strangers(left_out: np.ndarray, names: Sequence[str]) -> tuple[str, ...]:
    """A note on the repetitions that are like no other, by the distances (N, N) among all, infinite on the diagonal."""
    nearest = left_out.min(axis=1)
    usual = np.median(nearest)
    far = np.flatnonzero(nearest > STRANGE * usual)
    if len(names) < FEWEST_TO_JUDGE or usual <= 0 or len(far) == 0:
        return ()
    each = ", ".join(f"{names[i]} ({nearest[i] / usual:.0f} times as far as usual)" for i in far.tolist())
    return (f"far from every other repetition, another movement or a mistake: {each}",)
