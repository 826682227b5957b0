"""Bone lengths from stature by a published table, where a body's height is all that is known of its bones.

Source: Drillis & Contini (1964), Body Segment Parameters, as in Winter, Biomechanics and Motor Control of Human
Movement, fig. 4.1: segment lengths as fractions of stature, an average of both sexes. Single people differ from it by
some per cent. The table gives eight of the canonical skeleton's twenty bones: thighs, shanks, upper arms and forearms.
It does not divide the trunk at our joints, gives breadths over shoulders and hips where bones run slantwise from chest
and pelvis, and measures hand and foot to their tips where our joints end before: all those bones keep the proportion to
stature that the reference skeleton (the recorded people) has.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from emulator.covariates.body import BodyError, number_mistake
from emulator.skeleton import Skeleton

HEIGHT_SHARES: Mapping[str, float] = {
    "ankle": 0.039, "knee": 0.285, "fingertip": 0.377, "wrist": 0.485, "hip": 0.530, "elbow": 0.630, "chest": 0.720,
    "shoulder": 0.818, "chin": 0.870, "eyes": 0.936, "crown": 1.0,
}  # fmt: skip
"""Heights above the floor of somebody who stands upright, over his stature."""
LENGTH_SHARES: Mapping[str, float] = {
    "thigh": 0.245, "shank": 0.246, "upper_arm": 0.186, "forearm": 0.146, "hand": 0.108, "foot": 0.152,
    "foot_breadth": 0.055, "shoulder_half_breadth": 0.129, "hip_breadth": 0.191, "chest_breadth": 0.174,
}  # fmt: skip
"""Lengths over stature."""
SEGMENT_OF_BONE: Mapping[str, str] = {
    f"{side}_{joint}": segment
    for side in ("left", "right")
    for joint, segment in (("knee", "thigh"), ("ankle", "shank"), ("elbow", "upper_arm"), ("wrist", "forearm"))
}
"""The bones of the table: a bone is named after the joint where it ends."""


def bone_lengths_m(
    skeleton: Skeleton, height_m: float, reference_m: np.ndarray, reference_height_m: float | None = None
) -> np.ndarray:
    """Bone lengths (B,) in metres of somebody ``height_m`` tall.

    reference_m        : (B,) lengths of somebody (the mean of the recorded people): the bones that the table does not
                         give are his, in proportion to stature
    reference_height_m : his stature; None: what the table makes of his limbs
    Raises BodyError for a height that nobody has, ValueError for a reference of another skeleton.
    """
    wrong = number_mistake("body: height_m", "height_m", height_m, known=False)
    if wrong is not None:
        raise BodyError([wrong])
    tall = stature_m(skeleton, reference_m) if reference_height_m is None else reference_height_m
    length_m = np.asarray(reference_m, float) * (height_m / tall)
    for bone, name in enumerate(skeleton.bone_names):
        if name in SEGMENT_OF_BONE:
            length_m[bone] = height_m * LENGTH_SHARES[SEGMENT_OF_BONE[name]]
    return length_m


def stature_m(skeleton: Skeleton, bone_length_m: np.ndarray) -> float:
    """The stature at which the table's limbs are nearest to these bones (B,), by least squares.

    Raises ValueError for lengths of another skeleton, or one without any limb of the table.
    """
    bone_length_m = np.asarray(bone_length_m, float)
    if bone_length_m.shape != (skeleton.n_bones,):
        raise ValueError(f"bones: found {bone_length_m.shape}, expected ({skeleton.n_bones},) lengths")
    limbs = [i for i, name in enumerate(skeleton.bone_names) if name in SEGMENT_OF_BONE]
    if not limbs:
        raise ValueError(f"bones: none of {', '.join(SEGMENT_OF_BONE)} in this skeleton")
    share = np.array([LENGTH_SHARES[SEGMENT_OF_BONE[skeleton.bone_names[i]]] for i in limbs])
    return float(share @ bone_length_m[limbs] / (share @ share))


def not_in_the_table(skeleton: Skeleton) -> tuple[str, ...]:
    """The bones that keep the reference's proportion."""
    return tuple(name for name in skeleton.bone_names if name not in SEGMENT_OF_BONE)
