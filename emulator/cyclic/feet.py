"""Feet on the floor: how far they slide, and the way of the root if those that bear stay where they are.

A bearing foot may roll: over the ankle while it lands and stands, over the toe while it pushes off. It slides as far as
the one of the two that moves less. Source of the wish: Remillard & Kry (2010), fig. 2 (foot skate).
"""

from __future__ import annotations

import numpy as np

from emulator.skeleton import Skeleton, standard_skeleton

SIDES = ("left", "right")
RISE = 0.05
"""The heel rises where the foot points this much (of its length) further down than when it stands."""


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


def stretches(bears: np.ndarray) -> list[tuple[int, int]]:
    """(start, stop) of each run of True in (T,), stop one beyond its last frame."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(bears, int), [0]])))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2])]


def rise_frame(foot: np.ndarray, start: int, stop: int, *, held: bool = False) -> int:
    """The frame of a stance [start, stop) from which the foot turns about its toe: (T, 3) unit vectors ankle to toe.

    stop if it never does. held : the stance goes on to the end, where nobody pushes off.
    """
    if held or stop - start < 4:
        return stop
    down = -foot[start:stop, 2]
    middle = down[(stop - start) // 4 : max((stop - start) // 2, (stop - start) // 4 + 1)]
    flat = np.flatnonzero(down <= np.median(middle) + RISE)
    last = int(flat[-1]) if len(flat) else len(down) // 2
    return start + max(last, (stop - start) // 4)


def shares(contact: np.ndarray) -> np.ndarray:
    """(T, 2) how much each foot carries: 0 in the air, in double support from the old one to the new one evenly.

    Where both bear from the start or to the end each carries half; with no foot on the floor the last shares go on.
    """
    contact = np.asarray(contact, bool)
    share = contact.astype(float)
    for start, stop in stretches(np.all(contact, axis=1)):
        before = share[start - 1] if start else np.full(2, 0.5)
        after = share[stop] if stop < len(share) else np.full(2, 0.5)
        ease = ((np.arange(stop - start) + 1) / (stop - start + 1))[:, None]
        share[start:stop] = (1 - ease) * before + ease * after
    for start, stop in stretches(~np.any(contact, axis=1)):
        share[start:stop] = share[start - 1] if start else np.full(2, 0.5)
    total = share.sum(axis=1, keepdims=True)
    return np.asarray(share / np.where(total > 0, total, 1.0))


def path_from_contacts(hanging_m: np.ndarray, contact: np.ndarray, skeleton: Skeleton | None = None) -> np.ndarray:
    """The level way (T, 2) of the root of joints (T, J, 3), root at 0, if bearing feet stay; from x = y = 0.

    In double support both feet have their say by how much they carry.
    """
    skeleton = skeleton or standard_skeleton()
    share, way = shares(contact), np.zeros((len(hanging_m), 2))
    for number, side in enumerate(SIDES):
        ankle, toe = (hanging_m[:, skeleton.index(f"{side}_{joint}")] for joint in ("ankle", "toe"))
        step = np.diff(ankle[:, :2], axis=0)
        foot = toe - ankle
        foot = foot / np.linalg.norm(foot, axis=-1, keepdims=True)
        for start, stop in stretches(contact[:, number]):
            rise = rise_frame(foot, start, stop, held=stop == len(contact))
            step[rise : stop - 1] = np.diff(toe[rise:stop, :2], axis=0)
        carried = 0.5 * (share[1:, number] + share[:-1, number])
        way[1:] -= np.cumsum(carried[:, None] * step, axis=0)
    return way
