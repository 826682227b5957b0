"""Runs of frames."""

from __future__ import annotations

import numpy as np


def runs_of(true: np.ndarray) -> list[tuple[int, int]]:
    """(first, last) of each run of true values in (T,), both within."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(true, int), [0]])))
    return [(int(first), int(stop) - 1) for first, stop in zip(edges[::2], edges[1::2])]
