"""The recordings of a class in two halves of the same people; everything is learned from the first."""

from __future__ import annotations

from recordings import data_folder

from emulator.judge.held_out import N_KNOTS, N_TIMES, Halves, in_halves
from emulator.recordings import read_motions

__all__ = ["CLASSES", "N_KNOTS", "N_TIMES", "Halves", "halves", "path_of"]

CLASSES = ("sit_to_stand", "deep_squat", "side_lunge", "inline_lunge", "shoulder_abduction", "shoulder_scaption")


def path_of(task: str):
    return data_folder() / "motion" / f"uiprmd_{task}.npz"


def halves(task: str, split: int) -> Halves:
    """Correct and wrong repetitions, dealt out person by person."""
    return in_halves(read_motions(path_of(task), where=None), split)
