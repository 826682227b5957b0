"""Are drawn sequences as far from the training sequences as unseen real ones are? A copier is not."""

from __future__ import annotations

import numpy as np


def novelty(drawn_to_training: np.ndarray, unseen_to_training: np.ndarray) -> float:
    """Median distance of drawn sequences to the nearest training one, over that of unseen real ones.

    drawn_to_training (n, N), unseen_to_training (m, N) : distances; about 1 is honest, near 0 a copy
    NaN where half of the unseen lie on a training sequence.
    """
    usual = np.median(unseen_to_training.min(axis=1))
    return float(np.median(drawn_to_training.min(axis=1)) / usual) if usual > 0 else float("nan")
