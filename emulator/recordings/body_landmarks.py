"""Where head, shoulders, hips, knees and feet are, roughly, in named points: joints, keypoints or markers."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from emulator.recordings.dialect import joints_of
from emulator.recordings.joint_words import without_common_start
from emulator.recordings.marker_names import marker_name

PARTS = ("head", "shoulders", "hips", "knees", "feet")
_JOINTS = {
    "head": ("head", "nose", "left_ear", "right_ear", "left_eye", "right_eye"),
    "shoulders": ("neck", "left_shoulder", "right_shoulder"),
    "hips": ("pelvis", "left_hip", "right_hip"),
    "knees": ("left_knee", "right_knee"),
    "feet": ("left_ankle", "right_ankle", "left_toe", "right_toe", "left_heel", "right_heel"),
}
_MARKERS = {
    "head": r"[LR][FB]HD|ARIEL|TOPHEAD|HEAD(L|R|TOP|FRONT)",
    "shoulders": r"C7|CLAV|[LR]SHO|[LR]ACR",
    "hips": r"[LR](ASI|PSI|ASIS|PSIS)|SACR|SAC",
    "knees": r"[LR](KNE|KNM|MKNE|FLE|FME)",
    "feet": r"[LR](ANK|HEE|TOE|FAL|TAM|FCC|MT1|MT2|MT5|5MT|1MT)",
}
"""Skin markers of Plug-in Gait and of the sets derived from it."""


def part_places(positions: np.ndarray, names: Sequence[str]) -> dict[str, np.ndarray]:
    """The middle (T, 3) of each part of the body that these points (T, J, 3) know; nan where it was not seen."""
    joints = joints_of(names)
    bare = [marker_name(name) for name in without_common_start(names)]
    places = {}
    for part in PARTS:
        at = [i for i, joint in enumerate(joints) if joint in _JOINTS[part]]
        at = at or [i for i, name in enumerate(bare) if re.fullmatch(_MARKERS[part], name)]
        if at:
            places[part] = middle_of(positions[:, at])
    return places


def middle_of(points: np.ndarray) -> np.ndarray:
    """The mean over the points seen, (T, n, 3) -> (T, 3); nan where none is."""
    seen = np.isfinite(points).all(axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        total: np.ndarray = np.where(seen, points, 0.0).sum(axis=1) / seen.sum(axis=1)
    return total
