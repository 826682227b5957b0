from opsim.report.plot.body import COLOURS, body
from tests.opsim.report.test_strips import NAMES, PARENTS, Skeleton


def test_every_bone_but_the_ties_of_the_torso_is_a_limb():
    ties = {NAMES.index(f"{side}_{joint}") for side in ("left", "right") for joint in ("shoulder", "hip")}
    drawn = [(parent, joint) for parent, joint, *_ in body(Skeleton())["bones"]]
    assert drawn == [(parent, j) for j, parent in enumerate(PARENTS) if parent >= 0 and j not in ties]


def test_limbs_have_the_colour_of_their_side():
    colour = {NAMES[joint]: COLOURS[number] for _, joint, _, _, number in body(Skeleton())["bones"]}
    assert colour["left_knee"] != colour["right_knee"] and colour["neck"] not in (
        colour["left_knee"],
        colour["right_knee"],
    )


def test_a_thigh_is_thicker_than_a_forearm_and_both_taper():
    radii = {NAMES[joint]: (at, to) for _, joint, at, to, _ in body(Skeleton())["bones"]}
    assert radii["left_knee"][0] > radii["left_wrist"][0] > radii["left_wrist"][1] > 0
    assert radii["left_knee"][1] == radii["left_ankle"][0]


def test_a_skeleton_of_other_joints_is_drawn_whole():
    class Arm:
        names, parents = ("root", "upper", "tip"), (-1, 0, 1)

    drawn = body(Arm())
    assert len(drawn["bones"]) == 2 and drawn["torso"] == [] and drawn["head"] == -1 and drawn["feet"] == []
