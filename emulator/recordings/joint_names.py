"""What capture systems call a joint: words for the middle and for a limb without its side, and where the side stands.

A name loses its namespace and prefix, its side is looked for at every place, and the rest is looked up. Words whose
meaning depends on the whole skeleton (a shoulder is a collar bone beside an upper arm) are settled in ``dialect.py``.
Sources: the joint lists of Mixamo, CMU (ASF and BVH), Rokoko, Xsens MVN, Perception Neuron, OptiTrack Motive, 3ds Max
Biped, Unity and VRM, Bandai Namco, SMPL, Kinect 1, 2 and Azure, NTU RGB+D, OpenPose BODY_25, COCO, Halpe and
MediaPipe BlazePose.

The joints of one skeleton, its names read together: a shoulder beside an upper arm is a collar bone.

Rigs name a joint after the bone that STARTS there (LeftArm is the shoulder), ASF after the bone that ENDS there
(lhumerus is the elbow), keypoints after the joint itself.

Names of skin markers in other sets, as Plug-in Gait calls the markers at these places.

Sources: the marker sets of Qualisys (Animation, Sports) and OptiTrack Motive (Baseline), which name places alike.

The points of markerless trackers in the order in which they write them.

Sources: OpenPose (doc/02_output.md, BODY_25), COCO (keypoint detection task), MediaPipe (pose landmarker),
Halpe-FullBody; Kinect for Windows SDK 1.8 (NUI_SKELETON_POSITION_INDEX) and 2.0 (JointType), Azure Kinect body
tracking (k4abt_joint_id_t).

What became of each joint or marker of a file on the way to the canonical skeleton.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from emulator.skeleton import CANONICAL, EXTRA

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


_SIDED = {
    "SHOULDERTOP": "SHO", "ELBOWOUT": "ELB", "ELBOWIN": "MELB", "WRISTOUT": "WRA", "WRISTIN": "WRB", "HANDOUT": "FIN",
    "KNEEOUT": "KNE", "KNEEIN": "MKNE", "ANKLEOUT": "ANK", "ANKLEIN": "MMA", "TOETIP": "TOE", "HEELBACK": "HEE",
}  # fmt: skip
_OTHER = {
    "WAISTLFRONT": "LASI", "WAISTRFRONT": "RASI", "WAISTLBACK": "LPSI", "WAISTRBACK": "RPSI", "SPINETOP": "C7",
    "BACKTOP": "C7", "LASIS": "LASI", "RASIS": "RASI", "LPSIS": "LPSI", "RPSIS": "RPSI", "SACRUM": "SACR",
}  # fmt: skip


def marker_name(name: str) -> str:
    """A marker's name in capitals and without its person, by Plug-in Gait where another set has it there."""
    plain = re.sub(r"[^A-Z0-9]", "", bare_name(name).upper())
    if plain in _OTHER:
        return _OTHER[plain]
    return plain[0] + _SIDED[plain[1:]] if plain[:1] in ("L", "R") and plain[1:] in _SIDED else plain


def _sided(words: str) -> tuple[str, ...]:
    """Left and right of each word, one after the other."""
    return tuple(f"{side}_{word}" for word in words.split() for side in ("left", "right"))


COCO_17 = ("nose", *_sided("eye ear shoulder elbow wrist hip knee ankle"))
BODY_25 = (
    "Nose", "Neck", "RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist", "MidHip", "RHip", "RKnee",
    "RAnkle", "LHip", "LKnee", "LAnkle", "REye", "LEye", "REar", "LEar", "LBigToe", "LSmallToe", "LHeel", "RBigToe",
    "RSmallToe", "RHeel",
)  # fmt: skip
HALPE_26 = (
    "nose", *_sided("eye ear shoulder elbow wrist hip knee ankle"), "top_of_head", "neck", "hip",
    *_sided("big_toe small_toe heel"),
)  # fmt: skip
BLAZEPOSE_33 = (
    "nose", "left_eye_inner", "left_eye", "left_eye_outer", "right_eye_inner", "right_eye", "right_eye_outer",
    *_sided("ear"), "mouth_left", "mouth_right", *_sided("shoulder elbow wrist pinky index thumb hip knee ankle heel"),
    *_sided("foot_index"),
)  # fmt: skip
KINECT_20 = (
    "HipCenter", "Spine", "ShoulderCenter", "Head", "ShoulderLeft", "ElbowLeft", "WristLeft", "HandLeft",
    "ShoulderRight", "ElbowRight", "WristRight", "HandRight", "HipLeft", "KneeLeft", "AnkleLeft", "FootLeft",
    "HipRight", "KneeRight", "AnkleRight", "FootRight",
)  # fmt: skip
KINECT_25 = (
    "SpineBase", "SpineMid", "Neck", *KINECT_20[3:], "SpineShoulder", "HandTipLeft", "ThumbLeft", "HandTipRight",
    "ThumbRight",
)  # fmt: skip
KINECT_32 = (
    "PELVIS", "SPINE_NAVEL", "SPINE_CHEST", "NECK",
    *(
        f"{word}_{side}"
        for side in ("LEFT", "RIGHT")
        for word in ("CLAVICLE", "SHOULDER", "ELBOW", "WRIST", "HAND", "HANDTIP", "THUMB")
    ),
    *(f"{word}_{side}" for side in ("LEFT", "RIGHT") for word in ("HIP", "KNEE", "ANKLE", "FOOT")),
    "HEAD", "NOSE", "EYE_LEFT", "EAR_LEFT", "EYE_RIGHT", "EAR_RIGHT",
)  # fmt: skip
_BY_NUMBER = {"coco-17": COCO_17, "body-25": BODY_25, "halpe-26": HALPE_26, "blazepose-33": BLAZEPOSE_33}
KEYPOINTS = _BY_NUMBER | {"kinect-20": KINECT_20, "kinect-25": KINECT_25, "kinect-32": KINECT_32}
"""Known sets by name."""


def names_by_number(n_points: int) -> tuple[str, tuple[str, ...]]:
    """The known set of so many points: its name and its points; numbered points where none is.

    Those of Kinect have to be asked for: others have as many points in another order.
    """
    for name, points in _BY_NUMBER.items():
        if len(points) == n_points:
            return name, points
    return "no known set", tuple(f"point{i}" for i in range(n_points))


MOST_NAMED = 6


@dataclass(frozen=True)
class MappedJoint:
    """What became of a joint of the file: ``became`` is "kept", "made", "left out" or "unknown"."""

    name: str
    became: str
    joint: str = ""
    why: str = ""


@dataclass(frozen=True)
class MappingReport:
    """One row for each joint of the file and each joint made."""

    rows: tuple[MappedJoint, ...]

    def of(self, became: str) -> tuple[MappedJoint, ...]:
        """The rows of one kind."""
        return tuple(row for row in self.rows if row.became == became)

    def summary(self) -> str:
        """The numbers of joints of each kind in a sentence, with the names of those that are lost."""
        kinds = ("kept", "made", "left out", "unknown")
        return ", ".join(f"{len(rows)} {kind}{_lost(rows)}" for kind in kinds if (rows := self.of(kind)))


def _lost(rows: tuple[MappedJoint, ...]) -> str:
    """Names of joints that are left out, up to ``MOST_NAMED``."""
    if rows[0].became not in ("left out", "unknown"):
        return ""
    more = f" and {len(rows) - MOST_NAMED} more" if len(rows) > MOST_NAMED else ""
    return f" [{', '.join(row.name or row.joint for row in rows[:MOST_NAMED])}{more}]"
