"""Recordings in two halves of the same people; everything is learned from the first, the second is seen by nobody."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.align import align, align_to, resample
from emulator.held_out import split_within_workers
from emulator.holds import cut
from emulator.motion import MotionSet
from emulator.repair import repaired
from emulator.warp import clr, from_clr

N_TIMES, N_KNOTS = 301, 20
FEWEST_HELD = 5
"""Held-out repetitions with which anything can be judged."""


@dataclass(frozen=True, eq=False)
class Halves:
    """fitted, held : the recordings; a (N, T, B, 3), b (M, T, B, 3) : postures on the common clock of the first.

    split : the number that decided who lies in which half
    """

    split: int
    fitted: MotionSet
    held: MotionSet
    a: np.ndarray
    b: np.ndarray

    @property
    def task(self) -> str:
        return self.fitted.task


def in_halves(motions: MotionSet, split: int, n_times: int = N_TIMES) -> Halves:
    """Dealt out person by person; template and reference posture are those of the first half."""
    fitted, held = split_within_workers(motions, split)
    first, second = (cut(repaired(half))[0] for half in (fitted, held))
    found = align([m.directions for m in first.motions], n_times=n_times, n_threads=1)
    warps, _ = align_to([m.directions for m in second.motions], found.template, found.reference, n_threads=1)
    return Halves(split, fitted, held, _aligned(first, found.warps), _aligned(second, warps))


def too_few(motions: MotionSet) -> list[str]:
    """What speaks against halves of these recordings, in words; empty where nothing does."""
    each = np.bincount(motions.worker_index)
    n_held = int(np.sum(each // 2))
    if n_held >= FEWEST_HELD:
        return []
    people = f"{len(motions)} repetitions of {len(each)} people hold out {n_held}, one of two of each person"
    return [f"{motions.task}: {people}; expected {FEWEST_HELD} or more to judge by"]


def _aligned(motions: MotionSet, warps: np.ndarray) -> np.ndarray:
    """Postures along the warps that the model's pace coordinates can say."""
    n_times = warps.shape[1]
    smooth = from_clr(clr(warps, N_KNOTS), n_times)
    return np.stack([resample(m.directions, gamma) for m, gamma in zip(motions.motions, smooth)])
