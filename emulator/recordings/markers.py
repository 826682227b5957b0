"""On which joint each joint hangs: as in the file with what was left out bridged, or as bodies are made.

Joints from markers on the skin: Plug-in Gait's 39 (Vicon's full-body set) and sets that hold the same markers.

Trunk, head and wrists are middles of markers around them; hips by regression on the pelvis; shoulders, elbows, knees
and ankles stay on the skin, or become the middle where a marker on the inner side is there too.
Source of the hips: Harrington, Zavatsky, Lawson, Yuan & Theologis (2007), Prediction of the hip joint centre in adults,
children, and patients with cerebral palsy based on magnetic resonance imaging, J. Biomechanics 40(3):595-602, with the
pelvis' width and depth meant over the take. The other points are those of the shared UI-PRMD recordings.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from emulator.recordings.joint_names import MappedJoint, marker_name, without_common_start
from emulator.recordings.take import Take
from emulator.skeleton import CANONICAL

_TRUNK = ("pelvis", "spine", "chest", "upper_chest", "neck", "mid_neck", "upper_neck", "head")
_LIMBS = {
    "clavicle": ("upper_chest", "chest", "neck", "spine", "pelvis"),
    "shoulder": ("clavicle", "upper_chest", "chest", "neck", "spine", "pelvis"),
    "elbow": ("shoulder",),
    "wrist": ("elbow",),
    "hand": ("wrist", "elbow"),
    "fingers": ("hand", "wrist"),
    "thumb": ("hand", "wrist"),
    "hip": ("pelvis",),
    "knee": ("hip",),
    "ankle": ("knee",),
    "foot": ("ankle",),
    "toe": ("foot", "ankle"),
    "heel": ("ankle", "foot"),
}
_COINCIDENT_M = 1e-3
_FIRST = (
    "pelvis", "neck", "hip", "shoulder", "knee", "elbow", "ankle", "wrist", "head", "toe", "hand", "spine", "chest",
)  # fmt: skip
"""Of two joints at one place the one that comes first here stays."""


def hung_as_bodies_are(joints: Sequence[str]) -> tuple[int, ...]:
    """Parents of joints that have none: the nearest joint there is on the way to the pelvis, which is the root."""
    return tuple(joints.index(parent) if (parent := _nearest(joint, joints)) else -1 for joint in joints)


def _nearest(joint: str, joints: Sequence[str]) -> str:
    side, _, limb = joint.partition("_")
    if joint in _TRUNK:
        below = reversed(_TRUNK[: _TRUNK.index(joint)])
        return next((each for each in below if each in joints), "")
    for above in _LIMBS[limb]:
        for name in (f"{side}_{above}", above):
            if name in joints:
                return name
    return "pelvis"


def hung_as_in_the_file(parents: Sequence[int], at: Sequence[int]) -> tuple[int, ...] | None:
    """Parents among the kept joints ``at`` (numbers in the file); children of others hang on their nearest ancestor.

    None where more than one of them would be a root.
    """
    place = {joint: i for i, joint in enumerate(at)}
    kept = []
    for joint in at:
        above = parents[joint]
        while above >= 0 and above not in place:
            above = parents[above]
        kept.append(place.get(above, -1))
    return tuple(kept) if kept.count(-1) == 1 else None


def depths(parents: Sequence[int]) -> list[int]:
    """Joints from the root to each joint."""

    def depth(joint: int) -> int:
        steps = 0
        while parents[joint] >= 0 and steps <= len(parents):
            joint, steps = parents[joint], steps + 1
        return steps

    return [depth(joint) for joint in range(len(parents))]


def without_length(joints: Sequence[str], parents: Sequence[int], positions_m: np.ndarray) -> list[int]:
    """Numbers of the joints to leave out because they lie where their parent is (T, J, 3): no bone is without length.

    Of the two the one that is needed more stays.
    """
    out: list[int] = []
    for joint in sorted(range(len(joints)), key=depths(parents).__getitem__):
        parent = parents[joint]
        while parent in out:
            parent = parents[parent]
        if parent < 0:
            continue
        apart = np.linalg.norm(positions_m[:, joint] - positions_m[:, parent], axis=-1)
        seen = apart[np.isfinite(apart)]
        if len(seen) and np.median(seen) < _COINCIDENT_M:
            out.append(max(joint, parent, key=lambda j: _rank(joints[j])))
    return out


def _rank(joint: str) -> int:
    word = joint.removeprefix("left_").removeprefix("right_")
    return _FIRST.index(word) if word in _FIRST else len(_FIRST)


PLUG_IN_GAIT = (
    "LFHD", "RFHD", "LBHD", "RBHD", "C7", "T10", "CLAV", "STRN", "RBAK", "LSHO", "LUPA", "LELB", "LFRM", "LWRA", "LWRB",
    "LFIN", "RSHO", "RUPA", "RELB", "RFRM", "RWRA", "RWRB", "RFIN", "LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE",
    "LTIB", "LANK", "LHEE", "LTOE", "RTHI", "RKNE", "RTIB", "RANK", "RHEE", "RTOE",
)  # fmt: skip
"""The order of the columns of UI-PRMD's Vicon files."""
_MIDDLES: dict[str, tuple[tuple[str, ...], ...]] = {
    "pelvis": (("LASI", "RASI", "LPSI", "RPSI"),),
    "chest": (("T10", "STRN"), ("T10",), ("STRN",)),
    "neck": (("C7", "CLAV"), ("LSHO", "RSHO")),
    "head": (("LFHD", "RFHD", "LBHD", "RBHD"), ("LFHD", "RFHD"), ("LBHD", "RBHD"), ("HEADL", "HEADR"), ("HEADTOP",)),
}
_SIDED: dict[str, tuple[tuple[str, ...], ...]] = {
    "shoulder": (("SHO",), ("ACR",)),
    "elbow": (("ELB", "MELB"), ("ELB", "ELBM"), ("ELB",), ("ELBL",)),
    "wrist": (("WRA", "WRB"), ("WRI",), ("WRA",)),
    "hand": (("FIN",),),
    "knee": (("KNE", "MKNE"), ("KNE", "KNM"), ("KNE", "KNEM"), ("KNE",)),
    "ankle": (("ANK", "MMA"), ("ANK", "MED"), ("ANK", "ANKM"), ("ANK",)),
    "toe": (("TOE",),),
}
HARRINGTON = ((-0.24, -0.0099), (0.33, 0.0073), (-0.30, -0.0109))
"""Forward: pelvis depth; to the side: pelvis width; up: pelvis width; each factor and offset in metres."""
_SIGNS = ("LASI", "RASI", "LSHO", "RSHO", "LKNE", "RKNE")
"""Markers by which the set is known."""


def joints_from_markers(take: Take) -> tuple[Take, list[MappedJoint]] | None:
    """The take's joints out of its markers, and what became of each; None where it is no such set."""
    markers = _markers(take)
    if not set(_SIGNS) <= set(markers) or not ({"LPSI", "RPSI"} & set(markers)):
        return None
    made, ways = _joints(markers)
    joints = sorted(made, key=CANONICAL.index)
    rows = [MappedJoint("", "made", joint, ways[joint]) for joint in joints]
    used = " ".join(ways.values())
    plain = [marker_name(name) for name in without_common_start(take.names)]
    rows += [MappedJoint(name, "left out", "", "no joint") for name, word in zip(take.names, plain) if word not in used]
    note = "joints made of markers: hips by regression (Harrington 2007); shoulders, elbows, knees, ankles on the skin"
    positions = np.stack([made[joint] for joint in joints], axis=1)
    parents = hung_as_bodies_are(joints)
    return replace(take, names=tuple(joints), parents=parents, positions_m=positions, notes=(*take.notes, note)), rows


def _markers(take: Take) -> dict[str, np.ndarray]:
    """Positions (T, 3) by the marker's name in capitals, without the subject's name."""
    names = [marker_name(name) for name in without_common_start(take.names)]
    markers = {name: take.positions_m[:, i] for i, name in enumerate(names)}
    for other in ("SACR", "SAC"):  # one marker between the two of the back
        if other in markers and "LPSI" not in markers:
            markers |= {"LPSI": markers[other], "RPSI": markers[other]}
    return markers


def _joints(markers: Mapping[str, np.ndarray]) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Positions and what they are made of, by joint."""
    wanted = dict(_MIDDLES)
    for side, letter in (("left", "L"), ("right", "R")):
        wanted |= {f"{side}_{j}": tuple(tuple(letter + m for m in way) for way in ways) for j, ways in _SIDED.items()}
    made, ways = {}, {}
    for joint, choices in wanted.items():
        way = next((way for way in choices if all(marker in markers for marker in way)), None)
        if way is not None:
            made[joint] = np.mean([markers[marker] for marker in way], axis=0)
            ways[joint] = f"{'middle of ' if len(way) > 1 else ''}{', '.join(way)}"
    if "pelvis" in made and "chest" in made:
        made["spine"], ways["spine"] = (made["pelvis"] + made["chest"]) / 2, "middle of pelvis and chest"
    made["left_hip"], made["right_hip"] = hip_centres(markers)
    ways["left_hip"] = ways["right_hip"] = "regression on LASI, RASI, LPSI, RPSI"
    return made, ways


def hip_centres(markers: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Left and right hip joint centre (T, 3) from the four markers of the pelvis, in metres."""
    front, back = (markers["LASI"] + markers["RASI"]) / 2, (markers["LPSI"] + markers["RPSI"]) / 2
    across = markers["LASI"] - markers["RASI"]
    width_m, depth_m = (float(np.nanmean(np.linalg.norm(line, axis=-1))) for line in (across, front - back))
    left = _unit(across)
    up = _unit(np.cross(front - back, left))
    forward = np.cross(left, up)
    ahead, aside, above = (
        factor * size_m + offset_m for (factor, offset_m), size_m in zip(HARRINGTON, (depth_m, width_m, width_m))
    )
    middle = front + ahead * forward + above * up
    return middle + aside * left, middle - aside * left


def _unit(vectors: np.ndarray) -> np.ndarray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))
