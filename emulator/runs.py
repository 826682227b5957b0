"""Runs of frames."""

from __future__ import annotations

import numpy as np


def stretches(true: np.ndarray) -> list[tuple[int, int]]:
    """(start, stop) of each run of true values in (T,), stop one beyond its last frame."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(true, int), [0]])))
    return [(int(start), int(stop)) for start, stop in zip(edges[::2], edges[1::2])]
