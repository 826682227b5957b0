"""Draws by the people of a set of recordings, each as often as there: what recordings can be compared with."""

from __future__ import annotations

import numpy as np

from emulator.model import MotionEmulator
from emulator.motion import MotionSet
from emulator.performances import MotionPerformances


def draw_alike(emulator: MotionEmulator, motions: MotionSet, n: int, rng: np.random.Generator) -> MotionPerformances:
    """n performances by the known workers of ``motions``, in their proportions there, worker by worker.

    Raises ValueError for a worker that the emulator has not seen.
    """
    counts = apportioned(np.bincount(motions.worker_index), n)
    drawn = [emulator.sample(int(k), rng, worker=name).scores for name, k in zip(motions.workers, counts) if k]
    return emulator.performances(np.concatenate(drawn))


def apportioned(counts: np.ndarray, n: int) -> np.ndarray:
    """n shared out in the proportions of ``counts`` (W,), whole numbers, by largest remainder (first of equals)."""
    exact = n * counts / counts.sum()
    whole = np.floor(exact).astype(int)
    whole[np.argsort(whole - exact, kind="stable")[: n - whole.sum()]] += 1
    return whole
