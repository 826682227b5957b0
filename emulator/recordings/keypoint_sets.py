"""The points of markerless trackers in the order in which they write them.

Sources: OpenPose (doc/02_output.md, BODY_25), COCO (keypoint detection task), MediaPipe (pose landmarker),
Halpe-FullBody; Kinect for Windows SDK 1.8 (NUI_SKELETON_POSITION_INDEX) and 2.0 (JointType), Azure Kinect body
tracking (k4abt_joint_id_t).
"""

from __future__ import annotations


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
