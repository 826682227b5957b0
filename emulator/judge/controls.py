"""Controls: drawers that a good set of judges must see through."""

from __future__ import annotations

import numpy as np

from emulator.flatten import SIEM
from emulator.reduce import JointPCA

JITTER = 0.2


def resampler(training: np.ndarray, n: int, rng: np.random.Generator) -> np.ndarray:
    """n of the training sequences (N, T, B, 3), drawn with replacement: right in law, new in nothing."""
    return training[rng.integers(len(training), size=n)]


def jittered_resampler(training: np.ndarray, n: int, rng: np.random.Generator, jitter: float = JITTER) -> np.ndarray:
    """The same with a little Gaussian noise: ``jitter`` of the spread of each of all joint components.

    training (N, T, B, 3) on a common clock -> (n, T, B, 3).
    """
    siem = SIEM.fit(training)
    flat = siem.forward(training).reshape(len(training), -1)
    pca = JointPCA.fit(flat, 0.999999)
    scores = pca.forward(flat)
    noise = jitter * scores.std(axis=0, ddof=1) * rng.standard_normal((n, pca.n_components))
    drawn = pca.inverse(scores[rng.integers(len(scores), size=n)] + noise)
    return siem.inverse(drawn.reshape(n, training.shape[1], siem.n_channels))
