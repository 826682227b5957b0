"""Transition matrices between canonical postures in windows of normalised time."""

from __future__ import annotations

import numpy as np

WINDOW, STEP = 1 / 15, 1 / 30
"""Shares of the sequence: 20 and 10 of 301 points in the paper, 29 windows."""


def transition_matrices(
    labels: np.ndarray, n_postures: int, window: int | None = None, step: int | None = None
) -> np.ndarray:
    """Shares (W, K, K) of the changes from canonical posture i to j, in each window, over labels (M, T) from 0.

    window : changes in a window (points less one); step : points between the starts of two windows
    A row sums to 1; where no sequence is in posture i before the window's last point it is 0, as is the sum of the
    paper's formula. (Its own table cannot say: its baseline of 340-362 fits about 3.6 visited postures a window.)
    Raises ValueError for labels outside 0 to K - 1 and for windows that do not fit.
    Source: Chen, Park & Srivastava sec. 4.4 (3).
    """
    labels = np.atleast_2d(labels)
    last = labels.shape[1] - 1
    window = max(round(last * WINDOW), 1) if window is None else window
    step = max(round(last * STEP), 1) if step is None else step
    if not (1 <= window <= last and step >= 1):
        raise ValueError(f"transition_matrices: window {window}, step {step}, expected 1 to {last} and 1 or more")
    if labels.size and not (labels.min() >= 0 and labels.max() < n_postures):
        raise ValueError(
            f"transition_matrices: labels {labels.min()} to {labels.max()}, expected 0 to {n_postures - 1}"
        )
    counts = _counts(labels, n_postures)
    sums = np.concatenate([np.zeros_like(counts[:1]), np.cumsum(counts, axis=0)])
    starts = np.arange(0, last - window + 1, step)
    within = sums[starts + window] - sums[starts]
    return within / np.maximum(within.sum(axis=-1, keepdims=True), 1)


def transition_distance(a: np.ndarray, b: np.ndarray) -> float:
    """Summed absolute differences of two families of matrices (W, K, K); at most 2 W K.

    Raises ValueError for unequal shapes. Source: Chen, Park & Srivastava sec. 5.4, table 5 (L1 norm).
    """
    if a.shape != b.shape:
        raise ValueError(f"transition_distance: {a.shape} and {b.shape}, expected one shape")
    return float(np.abs(a - b).sum())


def uniform_transitions(n_windows: int, n_postures: int) -> np.ndarray:
    """The baseline (W, K, K): every change equally frequent, 1 / K. Source: [000] table 5."""
    return np.full((n_windows, n_postures, n_postures), 1.0 / n_postures)


def _counts(labels: np.ndarray, n_postures: int) -> np.ndarray:
    """Changes (T - 1, K, K) from each point to the next, over all sequences."""
    n_changes = labels.shape[1] - 1
    cell = (np.arange(n_changes) * n_postures + labels[:, :-1]) * n_postures + labels[:, 1:]
    return np.bincount(cell.ravel(), minlength=n_changes * n_postures**2).reshape(n_changes, n_postures, n_postures)
