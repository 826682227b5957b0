"""How many posture components: few, but enough for repetitions that had no part in making them."""

from __future__ import annotations

import numpy as np

LARGEST, SLACK, N_FOLDS = 36, 0.003, 10
FINE_RAD = 0.002
"""A bone's angle (0.1 degrees) that no recording knows better: components below it are of no use."""


def posture_size(sequences: np.ndarray, largest: int = LARGEST) -> int:
    """The smallest number of components at which held-out sequences (N, P) lose hardly more than at the best number.

    Hardly: ``SLACK`` of their mean distance to the mean sequence, or ``FINE_RAD`` a bone, coordinates being radians.
    In each of ten folds (every tenth sequence) the held-out ones are projected on the components of the rest; a fold
    spans fewer components than all sequences, and the number found is scaled up by that. The usual rule of one
    standard error takes half as many: repetitions differ more among each other than the errors of two sizes do.
    """
    gram = sequences @ sequences.T
    lost = np.concatenate([_lost(gram, held, largest) for held in _folds(len(sequences))])
    error = np.sqrt(lost).mean(axis=0)
    spread = np.sqrt(np.sum((sequences - sequences.mean(axis=0)) ** 2, axis=1)).mean()
    hardly = np.maximum(error.min() + SLACK * spread, FINE_RAD * np.sqrt(sequences.shape[1] / 2))
    enough = 1 + int(np.argmax(error <= hardly))
    span = len(sequences) - 1, len(sequences) - 1 - int(_folds(len(sequences))[0].sum())
    return min(largest, round(enough * span[0] / max(span[1], 1)))


def _folds(n: int) -> list[np.ndarray]:
    fold = np.arange(n) % min(N_FOLDS, n)
    return [fold == k for k in range(min(N_FOLDS, n))]


def _lost(gram: np.ndarray, held: np.ndarray, largest: int) -> np.ndarray:
    """(H, largest) squared distance of held-out sequences to what 1, 2, ... components of the others say of them."""
    n = int((~held).sum())
    mean = np.full(n, 1.0 / n)
    among, across = gram[~held][:, ~held], gram[held][:, ~held]
    centred = among - (among @ mean)[:, None] - (among @ mean)[None] + mean @ among @ mean
    offset = across - (across @ mean)[:, None] - (among @ mean)[None] + mean @ among @ mean
    whole = np.diag(gram)[held] - 2 * across @ mean + mean @ among @ mean
    values, vectors = np.linalg.eigh(centred)
    values, vectors = values[::-1][:largest], vectors[:, ::-1][:, :largest]
    real = values > max(values[0], 1e-300) * 1e-10
    scores = np.where(real, offset @ vectors / np.sqrt(np.where(real, values, 1.0)), 0.0)
    left = whole[:, None] - np.cumsum(scores**2, axis=1)
    padded = np.pad(left, ((0, 0), (0, largest - left.shape[1])), mode="edge")
    return np.asarray(np.maximum(padded, 0.0))
