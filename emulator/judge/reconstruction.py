"""What a reduction loses of sequences that it was not fitted to."""

from __future__ import annotations

import numpy as np

from emulator import sphere
from emulator.flatten import SIEM
from emulator.reduce import JointPCA


def reconstruction_error(sequences: np.ndarray, again: np.ndarray) -> float:
    """Mean distance (radians, summed over bones, mean over time) of sequences (n, T, B, 3) and their likes.

    Source: Chen, Park & Srivastava eq. 5.
    """
    return float(np.mean([sphere.distance(one, other).mean() for one, other in zip(sequences, again)]))


def joint_reconstruction(flatten: SIEM, reduce: JointPCA, sequences: np.ndarray) -> np.ndarray:
    """Sequences (n, T, B, 3) as their joint components give them back."""
    tangent = flatten.forward(sequences)
    flat = tangent.reshape(len(tangent), -1)
    return flatten.inverse(reduce.inverse(reduce.forward(flat)).reshape(tangent.shape))
