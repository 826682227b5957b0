"""Recordings in two halves of the same people; everything is learned from the first, the second is seen by nobody."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.align import align, align_to
from emulator.fit_settings import FitSettings
from emulator.held_out import split_within_workers
from emulator.model import SCHEME
from emulator.motion import MotionSet
from emulator.reduce import JointPCA
from emulator.registered import N_ALIGNED, moving_of, pace_components, penalised, postures_at, said_by
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
    first, second = (moving_of(repaired(half))[0] for half in (fitted, held))
    settings = FitSettings(SCHEME, None, n_times, N_KNOTS, 0.0, 0, "")
    penalty, _ = penalised(first, settings)
    grid = min(n_times, N_ALIGNED)
    found = align([m.directions for m in first.motions], n_times=grid, penalty=penalty, n_threads=1)
    theirs = [m.directions for m in second.motions]
    warps, _ = align_to(theirs, found.template, found.reference, penalty=penalty, n_threads=1)
    pace = pace_components(clr(found.warps, N_KNOTS))
    a, b = (_aligned(half, gamma, pace, n_times) for half, gamma in ((first, found.warps), (second, warps)))
    return Halves(split, fitted, held, a, b)


def too_few(motions: MotionSet) -> list[str]:
    """What speaks against halves of these recordings, in words; empty where nothing does."""
    each = np.bincount(motions.worker_index)
    n_held = int(np.sum(each // 2))
    if n_held >= FEWEST_HELD:
        return []
    people = f"{len(motions)} repetitions of {len(each)} people hold out {n_held}, one of two of each person"
    return [f"{motions.task}: {people}; expected {FEWEST_HELD} or more to judge by"]


def _aligned(motions: MotionSet, warps: np.ndarray, pace: JointPCA, n_times: int) -> np.ndarray:
    """Postures along the warps that the model's pace coordinates can say."""
    smooth = from_clr(said_by(pace, clr(warps, N_KNOTS)), n_times)
    return np.stack([postures_at(m.directions, gamma) for m, gamma in zip(motions.motions, smooth)])
