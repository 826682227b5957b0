import numpy as np

from emulator.skeleton import standard_skeleton
from emulator.synthetic.choreography import REST, Body, joints_m, soft_target, two_bones

SKELETON = standard_skeleton()


def rest(n=1, **changes):
    fields = {
        name: np.broadcast_to(np.asarray(changes.get(name, value), float), (n, len(value)))
        for name, value in REST.items()
    }
    return fields


def test_a_limb_reaches_a_target_within_reach_with_its_own_lengths():
    start, target = np.zeros((1, 3)), np.array([[0.3, 0.1, -0.2]])
    middle, end = two_bones(start, target, 0.3, 0.25, np.array([[0.0, 0, -1]]))
    assert np.allclose(end, target)
    assert np.isclose(np.linalg.norm(middle - start), 0.3)
    assert np.isclose(np.linalg.norm(end - middle), 0.25)


def test_a_target_out_of_reach_is_approached_on_the_straight_line():
    _, end = two_bones(np.zeros((1, 3)), np.array([[2.0, 0, 0]]), 0.3, 0.25, np.array([[0.0, 0, -1]]))
    assert np.allclose(end, [[0.999 * 0.55, 0, 0]])


def test_a_near_target_is_kept_and_a_far_one_drawn_in_without_a_kink():
    distance = np.linspace(0.1, 3.0, 2901)
    drawn = soft_target(np.zeros((1, 3)), np.stack([distance, 0 * distance, 0 * distance], axis=-1), 1.0)[:, 0]
    assert np.allclose(drawn[distance <= 0.9], distance[distance <= 0.9], atol=1e-15)
    assert np.all(np.diff(drawn) >= 0) and drawn.max() <= 0.999
    assert np.abs(np.diff(drawn, 2)).max() < 2e-5


def test_bones_keep_their_lengths_in_any_posture():
    upright = SKELETON.bone_lengths(joints_m(rest(), Body()))
    bent = rest(
        pelvis=(-0.1, 0, 0.6), pitch=[0.8], lean=[0.1], twist=[0.3], right_wrist=(0.4, -0.2, 0.3), left_toe=[0.3]
    )
    assert np.allclose(SKELETON.bone_lengths(joints_m(bent, Body())), upright, atol=1e-12)


def test_knees_bend_forward_and_elbows_back():
    at = dict(zip(SKELETON.names, joints_m(rest(pelvis=(-0.1, 0, 0.6), right_wrist=(0.3, -0.2, 1.1)), Body())[0]))
    assert at["left_knee"][0] > max(at["left_hip"][0], at["left_ankle"][0])
    line = at["right_wrist"] - at["right_shoulder"]
    assert np.cross(line, at["right_elbow"] - at["right_shoulder"])[1] > 0  # below the line from shoulder to wrist


def test_a_person_stands_on_the_floor_as_tall_as_said():
    for stature in (1.55, 1.75, 1.95):
        at = dict(zip(SKELETON.names, joints_m(rest(), Body(stature))[0]))
        assert np.isclose(at["head"][2] + 0.12 * stature / 1.75, stature, atol=0.02)
        assert 0.0 < at["left_toe"][2] < at["left_ankle"][2]


def test_planted_ankles_stay_while_the_body_sinks():
    low = joints_m(rest(pelvis=(-0.2, 0, 0.55)), Body())[0]
    assert np.allclose(low[SKELETON.index("left_ankle")], REST["left_ankle"])
