"""One class of recordings in two halves of the same people; everything is learned from the first."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from recordings import data_folder

from emulator.align import align, align_to, resample
from emulator.held_out import split_within_workers
from emulator.holds import cut
from emulator.motion import MotionSet
from emulator.recordings import read_motions
from emulator.repair import repaired
from emulator.warp import clr, from_clr

CLASSES = ("sit_to_stand", "deep_squat", "side_lunge", "inline_lunge", "shoulder_abduction", "shoulder_scaption")
N_TIMES, N_KNOTS = 301, 20


@dataclass(frozen=True, eq=False)
class Halves:
    """fitted, held : the recordings; a (N, T, B, 3), b (M, T, B, 3) : postures on the common clock of the first."""

    task: str
    split: int
    fitted: MotionSet
    held: MotionSet
    a: np.ndarray
    b: np.ndarray


def path_of(task: str):
    return data_folder() / "motion" / f"uiprmd_{task}.npz"


def halves(task: str, split: int) -> Halves:
    """Correct and wrong repetitions, dealt out person by person; template and reference from the first half."""
    fitted, held = split_within_workers(read_motions(path_of(task), where=None), split)
    first, second = (cut(repaired(half))[0] for half in (fitted, held))
    registered = align([m.directions for m in first.motions], n_times=N_TIMES, n_threads=1)
    ours = [m.directions for m in second.motions]
    warps, _ = align_to(ours, registered.template, registered.reference, n_threads=1)
    return Halves(task, split, fitted, held, _aligned(first, registered.warps), _aligned(second, warps))


def _aligned(motions: MotionSet, warps: np.ndarray) -> np.ndarray:
    """Postures along the warps that the model's pace coordinates can say."""
    smooth = from_clr(clr(warps, N_KNOTS), N_TIMES)
    return np.stack([resample(m.directions, gamma) for m, gamma in zip(motions.motions, smooth)])
