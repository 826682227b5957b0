"""Bodies built by forward kinematics from angles of joints, with the lengths of the reference skeletons.

Key numbers of ``ergonomic_cases.json`` (skeletons), so that a clean clone tests them too: the angles each is built
with are the angles to be measured, since z is up, x forward, y left and trunk angles are taken one at a time.
"""

import numpy as np

from tests.opsim.ergonomics.bodies import turn

X, Y, Z = np.eye(3)
SIDES = (("left", 1.0), ("right", -1.0))
CASES = {
    "standing": {},
    "stoop, arms hang": {"trunk": 70, "neck": -10, "arm": 70},
    "bent and twisted": {"trunk": 45, "twist": 25, "arm": 50, "elbow": 30, "wrist": 12},
    "arms abducted": {"abduction": 80, "elbow": 10},
    "seated": {"arm": 15, "elbow": 90, "knee": 90},
    "looking up, arms high": {"neck": -25, "arm": 100, "elbow": 40},
}
LIMBS = ("shoulder", "elbow", "wrist", "hand", "hip", "knee", "ankle", "toe")
NAMES = ("pelvis", "neck", "head", *(f"{side}_{joint}" for side, _ in SIDES for joint in LIMBS))


def built(trunk=0, neck=0, twist=0, arm=0, abduction=0, elbow=0, wrist=0, knee=0):
    """(19, 3) metres: degrees of flexion of trunk, neck and arms, twist of the trunk, bends of the limbs."""
    joints = {"pelvis": np.array([0, 0, 0.91])}
    spine = turn(Y, trunk) @ turn(Z, twist)
    joints["neck"] = joints["pelvis"] + spine @ (0.5 * Z)
    joints["head"] = joints["neck"] + spine @ turn(Y, neck) @ (0.2 * Z)
    for side, own in SIDES:
        joints[f"{side}_shoulder"] = joints["pelvis"] + spine @ [0, own * 0.19, 0.46]
        upper = spine @ turn(X, own * abduction) @ turn(Y, -arm)
        fore = upper @ turn(Y, -elbow)
        _chain(joints, side, "shoulder", (("elbow", upper, 0.29), ("wrist", fore, 0.26)))
        _chain(joints, side, "wrist", (("hand", fore @ turn(Y, -wrist), 0.09),))
        thigh = turn(Y, -90) if knee == 90 else np.eye(3)
        joints[f"{side}_hip"] = joints["pelvis"] + own * 0.09 * Y
        _chain(joints, side, "hip", (("knee", thigh, 0.43), ("ankle", np.eye(3), 0.43)))
        joints[f"{side}_toe"] = joints[f"{side}_ankle"] + 0.2 * X
    return np.array([joints[name] for name in NAMES])


def _chain(joints, side, start, links):
    """Bones that hang one on the other, each along its own down."""
    for name, rotation, length_m in links:
        joints[f"{side}_{name}"] = joints[f"{side}_{start}"] - rotation @ (length_m * Z)
        start = name
