"""How roughly postures change: the way they go from step to step, and its acceleration on their spheres."""

from __future__ import annotations

import numpy as np

from emulator import sphere


def temporal_roughness(directions: np.ndarray) -> float:
    """Mean distance (radians, summed over bones) of successive postures of sequences (n, T, B, 3).

    A wandering of the size of a step shows, a fine trembling hardly: see ``roughness``.
    Source: Chen, Park & Srivastava sec. 5.2, d_Y(alpha(t), alpha(t + 1)) with eq. 1.
    """
    return float(np.mean([sphere.distance(one[1:], one[:-1]).mean() for one in directions]))


def roughness(directions: np.ndarray) -> float:
    """Mean length (radians per step squared) of the second difference of sequences (n, T, B, 3) along their spheres.

    The second difference of unit vectors, less its part towards the middle one (bending of the sphere, not of the
    path); root sum of squares over the bones, mean over times and sequences. T >= 3.
    """
    if directions.shape[1] < 3:
        raise ValueError(f"roughness: sequences of {directions.shape[1]} postures, expected at least 3")
    return float(np.mean([_second_difference(sequence) for sequence in directions]))


def _second_difference(sequence: np.ndarray) -> float:
    middle = sequence[1:-1]
    around = sequence[2:] + sequence[:-2]
    along = around - np.einsum("tbc,tbc->tb", around, middle)[..., None] * middle
    return float(np.sqrt(np.einsum("tbc,tbc->t", along, along)).mean())
