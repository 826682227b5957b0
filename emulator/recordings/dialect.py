"""The joints of one skeleton, its names read together: a shoulder beside an upper arm is a collar bone.

Rigs name a joint after the bone that STARTS there (LeftArm is the shoulder), ASF after the bone that ENDS there
(lhumerus is the elbow), keypoints after the joint itself.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from emulator.recordings.joint_words import TRUNK, bare_name, said, without_common_start
from emulator.skeleton import CANONICAL, EXTRA

_ASF = {
    "clavicle_bone": "shoulder", "hip_bone": "hip", "hand_or_wrist": "hand", "foot_or_ankle": "foot",
    "wrist_point": "other",
    "thorax": "neck", "lower_neck": "mid_neck",
}  # fmt: skip
_ASF_TRUNK = {"lowerback": "spine", "upperback": "chest"}
_FACE = ("nose", "top", "eye", "ear", "index", "pinky", "knuckle", "other")
"""Points that are no joints; some of them are used where the joint itself is missing."""
END = re.compile(r"[\s_.]*(?:end(?:[\s_]*site)?|nub)$", re.IGNORECASE)


def joints_of(names: Sequence[str], depth: Sequence[int] | None = None) -> tuple[str, ...]:
    """For each name its joint (``CANONICAL`` or ``EXTRA``), ``"side_word"`` for a point that is none, or "".

    depth : joints from the root to each, where there is a hierarchy; of two that mean the same joint the one further
            out is taken, since rigs put a bone without length at its top
    """
    names = without_common_start(names)
    words = [said(name) for name in names]
    spoken = {word for _, word in words}
    if {"knee", "elbow"} <= spoken and any("humerus" in name.lower() for name in names):
        return _only_once([_asf(name, *word) for name, word in zip(names, words)], names, depth)
    plain = _plain_words(spoken)
    joints = [_joined(side, plain.get(word, word)) for side, word in words]
    joints = _ends(names, joints)
    return _only_once(_trunk(names, joints, depth), names, depth)


def _asf(name: str, side: str, word: str) -> str:
    word = _ASF_TRUNK.get(bare_name(name).lower(), _ASF.get(word, word))
    return _joined(side, "pelvis" if word == "root" else word)


def _plain_words(spoken: set[str]) -> dict[str, str]:
    """What the words that depend on others mean here."""
    bones = "shoulder" in spoken and "shoulder_or_clavicle" in spoken
    wrist = "wrist_point" in spoken
    ankle, toe = "ankle" in spoken, "toe" in spoken
    return {
        "clavicle_bone": "clavicle",
        "shoulder_or_clavicle": "clavicle" if bones else "shoulder",
        "hip_bone": "other" if "hip" in spoken else "hip",
        "hand_or_wrist": "hand" if wrist else "wrist",
        "wrist_point": "wrist",
        "foot_or_ankle": "ankle" if not ankle else "foot" if toe else "toe",
        "thorax": TRUNK if "neck" in spoken else "neck",
        "lower_neck": "mid_neck" if "neck" in spoken else "neck",
        "root": "pelvis" if "pelvis" not in spoken else "other",
    }


def _joined(side: str, word: str) -> str:
    joint = f"{side}_{word}" if side and word else word
    known = joint in CANONICAL or joint in EXTRA or joint == TRUNK or word in _FACE
    return joint if known else ""


def _ends(names: Sequence[str], joints: list[str]) -> list[str]:
    """The end of a foot or a hand is toe or hand where the skeleton has none such."""
    by_bare = {bare_name(name): joint for name, joint in zip(names, joints)}
    given = set(joints)
    for i, name in enumerate(names):
        stem = END.sub("", bare_name(name))
        if joints[i] or stem == bare_name(name):
            continue
        of = by_bare.get(stem, "")
        outer = of.replace("_ankle", "_toe").replace("_wrist", "_hand").replace("_foot", "_toe")
        joints[i] = outer if outer != of and outer not in given else "end"
    for i, joint in enumerate(joints):  # a knuckle is the hand where there is no hand
        hand = joint.replace("_knuckle", "_hand")
        if hand != joint:
            joints[i] = hand if hand not in joints else joint.replace("_knuckle", "_other")
    return joints


def _trunk(names: Sequence[str], joints: list[str], depth: Sequence[int] | None) -> list[str]:
    """Spine, chest and upper chest out of the joints between pelvis and neck, by their order from below."""
    chain = [i for i, joint in enumerate(joints) if joint == TRUNK]
    own = {"spine": "spine", "chest": "chest", "upperchest": "upper_chest", "upper_chest": "upper_chest"}
    said_so = [own.get(re.sub(r"[^a-z]", "", bare_name(names[i]).lower()), "") for i in chain]
    digits = any(re.search(r"\d", bare_name(names[i])) for i in chain)
    chain = sorted(chain, key=lambda i: (depth[i] if depth is not None else 0, i))
    if not digits and all(said_so) and len(set(said_so)) == len(said_so):
        for i, joint in zip([i for i, j in enumerate(joints) if j == TRUNK], said_so):
            joints[i] = joint
        return joints
    middle = len(chain) // 2
    chosen = {0: "spine"} if len(chain) < 3 else {0: "spine", middle: "chest", len(chain) - 1: "upper_chest"}
    if len(chain) == 2:
        chosen[1] = "chest"
    for place, i in enumerate(chain):
        joints[i] = chosen.get(place, "other")
    return joints


def _only_once(joints: list[str], names: Sequence[str], depth: Sequence[int] | None) -> tuple[str, ...]:
    """Of joints found twice the plainest name's, or else the outermost's; the others become points beside it."""
    for joint in {j for j in joints if j in CANONICAL or j in EXTRA}:
        places = [i for i, other in enumerate(joints) if other == joint]
        best = max(places, key=lambda i: (_same(names[i], joint), depth[i] if depth is not None else 0, -i))
        for i in places:
            if i != best:
                joints[i] = "other"
    return tuple(joints)


def _same(name: str, joint: str) -> bool:
    return re.sub(r"[^a-z]", "", bare_name(name).lower()) == joint.replace("_", "")
