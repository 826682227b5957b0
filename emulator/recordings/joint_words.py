"""What capture systems call a joint: words for the middle and for a limb without its side, and where the side stands.

A name loses its namespace and prefix, its side is looked for at every place, and the rest is looked up. Words whose
meaning depends on the whole skeleton (a shoulder is a collar bone beside an upper arm) are settled in ``dialect.py``.
Sources: the joint lists of Mixamo, CMU (ASF and BVH), Rokoko, Xsens MVN, Perception Neuron, OptiTrack Motive, 3ds Max
Biped, Unity and VRM, Bandai Namco, SMPL, Kinect 1, 2 and Azure, NTU RGB+D, OpenPose BODY_25, COCO, Halpe and
MediaPipe BlazePose.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

TRUNK = "trunk"
"""The class of everything between pelvis and neck: which one is spine, chest or upper chest says their order."""

MIDDLE = {
    "hips": "pelvis", "pelvis": "pelvis", "hip": "pelvis", "midhip": "pelvis", "centerhip": "pelvis",
    "hipcenter": "pelvis", "hipscenter": "pelvis", "spinebase": "pelvis", "baseofthespine": "pelvis",
    "root": "root", "reference": "root",
    "neck": "neck", "neck1": "mid_neck", "neck2": "upper_neck", "lowerneck": "lower_neck", "midneck": "mid_neck",
    "upperneck": "upper_neck", "neckbase": "neck", "c7": "neck", "midshoulder": "neck", "neck01": "neck",
    "neck02": "mid_neck", "shouldercenter": "neck",
    "head": "head", "headbase": "head", "skull": "head",
    "thorax": "thorax", "spineshoulder": TRUNK, "spinemid": TRUNK, "torso": TRUNK, "abdomen": TRUNK, "ab": TRUNK,
    "waist": TRUNK, "lowerback": TRUNK, "upperback": TRUNK, "back": TRUNK, "lowerspine": TRUNK, "upperspine": TRUNK,
    "midspine": TRUNK, "spineupper": TRUNK, "spinelower": TRUNK, "upperchest": TRUNK, "lumbar": TRUNK,
    "middleofthespine": TRUNK, "spinenavel": TRUNK, "spinechest": TRUNK,
    "sternum": TRUNK, "l5": TRUNK, "l3": TRUNK, "t12": TRUNK, "t8": TRUNK,
    "bip01": "root", "bip001": "root", "nose": "nose", "headtop": "top", "topofhead": "top", "vertex": "top",
}  # fmt: skip
LIMB = {
    "collar": "clavicle", "collarbone": "clavicle", "clavicle": "clavicle_bone", "shoulderblade": "clavicle",
    "scapula": "clavicle", "shoulder": "shoulder_or_clavicle",
    "arm": "shoulder", "upperarm": "shoulder", "uparm": "shoulder", "uarm": "shoulder", "bicep": "shoulder",
    "humerus": "elbow", "elbow": "elbow", "forearm": "elbow", "lowerarm": "elbow", "farm": "elbow", "lowarm": "elbow",
    "radius": "wrist", "wrist": "wrist_point", "hand": "hand_or_wrist", "knuckles": "hand", "fingerbase": "hand",
    "handmiddle1": "knuckle", "handindex1": "knuckle", "middleproximal": "knuckle", "middle1": "knuckle",
    "fingers": "fingers", "handtip": "fingers", "finger": "fingers", "thumb": "thumb", "index": "index",
    "tipofthehand": "fingers", "pinky": "pinky",
    "hipjoint": "hip_bone", "hip": "hip", "upleg": "hip", "upperleg": "hip", "thigh": "hip",
    "femur": "knee", "knee": "knee", "leg": "knee", "lowerleg": "knee", "lowleg": "knee", "shin": "knee",
    "calf": "knee", "tibia": "ankle", "ankle": "ankle", "foot": "foot_or_ankle", "heel": "heel", "toes": "toe",
    "toe": "toe", "toebase": "toe", "toe0": "toe", "ball": "toe", "bigtoe": "toe", "footindex": "toe", "hallux": "toe",
    "forefoot": "toe", "eye": "eye", "ear": "ear", "smalltoe": "other", "eyeinner": "other", "eyeouter": "other",
    "mouth": "other",
}  # fmt: skip
_PREFIX = re.compile(
    r"^(mixamorig\d*|bip0*1|valvebiped|j_?bip_?[clr]?|jbip|cc_base|def|org|jnt|joint|bone|character\d+|armature|rig|skel)"
    r"[\s_.:-]+",
    re.IGNORECASE,
)
_TRUNK_NUMBERED = re.compile(r"^(spine|chest|torso|spine0*)\d*$")
_FINGER = re.compile(r"^(in)?(hand)?(thumb|index|middle|ring|pinky|little|finger)\w*?\d*(proximal|distal|\w*)$")


@cache
def said(name: str) -> tuple[str, str]:
    """The side ("left", "right" or "") and the word for what a name means; ("", "") for one that is not known."""
    bare = bare_name(name)
    for side, rest in _readings(bare):
        meaning = _meaning(side, rest)
        if meaning:
            return side, meaning
    return "", ""


def bare_name(name: str) -> str:
    """A name without namespace (``Subject:``) and without the prefix of its rig (``mixamorig:``, ``Bip01``)."""
    bare = re.split(r"[:|]", name)[-1].strip()
    for _ in range(2):
        lost = _PREFIX.sub("", bare)
        letter = re.match(r"(?i)^j_?bip_?([lr])_", bare)  # VRM says the side in the prefix
        bare = f"{letter.group(1)}_{lost}" if letter else lost
    return bare


def without_common_start(names: Sequence[str]) -> list[str]:
    """The names without what all begin with up to a sign, such as the person in ``Ana_LFHD``; a side is kept."""
    bare = [re.split(r"[:|]", name)[-1].strip() for name in names]
    start = re.match(r".*[_.\-\s]", _common_start(bare)) if len(bare) > 3 else None
    if start is None or _PREFIX.match(bare[0]) or _plain(start[0]) in ("", "l", "r", "left", "right"):
        return list(names)
    return [name[start.end() :] for name in bare]


def _common_start(words: Sequence[str]) -> str:
    first, last = min(words), max(words)
    n = next((i for i, (a, b) in enumerate(zip(first, last)) if a != b), min(len(first), len(last)))
    return first[:n]


def known_words() -> list[str]:
    """Names as a person would write them, for the nearest word."""
    sided = [f"{side}_{word}" for word in LIMB for side in ("left", "right")]
    return [*MIDDLE, "spine", "chest", *sided]


def _meaning(side: str, rest: str) -> str:
    if not side:
        return MIDDLE.get(rest) or (TRUNK if _TRUNK_NUMBERED.match(rest) else "")
    if rest in LIMB:
        return LIMB[rest]
    return "other" if _FINGER.match(rest) or "twist" in rest else ""


def _readings(bare: str) -> list[tuple[str, str]]:
    """(side, rest) of every way to read a name, the likeliest first: no side, a word, a letter apart, a letter."""
    plain = _plain(bare)
    readings = [("", plain)]
    for side in ("left", "right"):
        if side in plain:
            readings.append((side, plain.replace(side, "", 1)))
    tokens = [_plain(token) for token in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", bare)]
    for place, token in enumerate(tokens):
        if token in ("l", "r"):
            readings.append((_SIDES[token], "".join([*tokens[:place], *tokens[place + 1 :]])))
    if plain[:1] in _SIDES:
        readings.append((_SIDES[plain[0]], plain[1:]))
    if plain[-1:] in _SIDES and len(plain) > 1:
        readings.append((_SIDES[plain[-1]], plain[:-1]))
    return readings


_SIDES = {"l": "left", "r": "right"}


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower()).replace("centre", "center")
