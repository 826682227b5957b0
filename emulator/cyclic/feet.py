"""Feet on the floor: how far they slide, and the way of the root if those that bear stay where they are.

A bearing foot may roll: over the ankle while it lands and stands, over the toe while it pushes off. It slides as far as
the one of the two that moves less. Source of the wish: Remillard & Kry (2010), fig. 2 (foot skate).
"""

from __future__ import annotations

import numpy as np

from emulator.runs import stretches
from emulator.skeleton import Skeleton, standard_skeleton

SIDES = ("left", "right")


def foot_skate_m(
    positions_m: np.ndarray, contact: np.ndarray, skeleton: Skeleton | None = None, *, least_frames: int = 3
) -> np.ndarray:
    """Metres that each bearing foot slides on the floor, one number a stance.

    positions_m : (T, J, 3), contact : (T, 2) left and right foot bear; stances shorter than ``least_frames`` are left
    out. From frame to frame the slide is the lesser of the ankle's and the toe's, so that a foot may roll.
    Returns (S,), left stances first; its mean is the foot skate a step. Raises ValueError for a skeleton without feet.
    """
    skeleton = skeleton or standard_skeleton()
    slid = []
    for side, bears in zip(SIDES, np.asarray(contact, bool).T):
        joints = positions_m[:, [skeleton.index(f"{side}_ankle"), skeleton.index(f"{side}_toe")], :2]
        step = np.linalg.norm(np.diff(joints, axis=0), axis=-1).min(axis=1)
        slid += [
            float(step[start : stop - 1].sum()) for start, stop in stretches(bears) if stop - start >= least_frames
        ]
    return np.array(slid)


def shares(contact: np.ndarray) -> np.ndarray:
    """(T, 2) how much each foot carries: 0 in the air, in double support from the old one to the new one evenly.

    Where both bear from the start or to the end each carries half; with no foot on the floor the last shares go on.
    """
    from emulator.kernels.ridden import shared

    share = np.empty(np.shape(contact))
    shared(np.asarray(contact, bool), share)
    return share


def path_from_contacts(hanging_m: np.ndarray, contact: np.ndarray, skeleton: Skeleton | None = None) -> np.ndarray:
    """The level way (T, 2) of the root of joints (T, J, 3), root at 0, if bearing feet stay; from x = y = 0.

    In double support both feet have their say by how much they carry.
    """
    from emulator.kernels.ridden import ridden

    skeleton = skeleton or standard_skeleton()
    feet = np.array([[skeleton.index(f"{side}_{joint}") for joint in ("ankle", "toe")] for side in SIDES])
    way = np.empty((len(hanging_m), 2))
    ridden(np.ascontiguousarray(hanging_m, dtype=float), np.asarray(contact, bool), feet, way)
    return way
