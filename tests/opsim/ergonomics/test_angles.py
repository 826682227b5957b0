import json
import warnings

import numpy as np
import pytest
from recordings import reference

from opsim.ergonomics.angles import (
    CANONICAL,
    elbow_bend_rad,
    knee_bend_rad,
    neck_angles,
    neck_neutral_rad,
    trunk_angles,
    trunk_flexion_rad,
    upper_arm_angles,
    wrist_bend_rad,
)
from tests.opsim.ergonomics.bodies import arm, bent, mirrored, moved, standing, turn

X, Y, Z = np.eye(3)


def every_angle(body):
    """name -> degrees, sides left and right along the last axis."""
    trunk, neck = trunk_angles(body, CANONICAL), neck_angles(body, CANONICAL)
    found = {"trunk_flex": trunk.flexion_rad, "trunk_side": trunk.side_bend_rad, "trunk_twist": trunk.twist_rad}
    found |= {"neck_flex": neck.flexion_rad, "neck_side": neck.side_bend_rad}
    for against in ("trunk", "gravity"):
        arms = upper_arm_angles(body, CANONICAL, against)
        named = {"flex": arms.flexion_rad, "abd": arms.abduction_rad, "elevation": arms.elevation_rad}
        found |= {f"{against} {name}": angle for name, angle in named.items()}
    found |= {"elbow": elbow_bend_rad(body, CANONICAL), "knee": knee_bend_rad(body, CANONICAL)}
    return {name: np.rad2deg(angle) for name, angle in (found | {"wrist": wrist_bend_rad(body, CANONICAL)}).items()}


def trunk_deg(body):
    angles = trunk_angles(body, CANONICAL)
    return np.rad2deg([angles.flexion_rad, angles.side_bend_rad, angles.twist_rad])


@pytest.fixture(scope="module")
def anybody():
    """Fifty bodies (50, 21, 3) in no posture that has a name."""
    rng = np.random.default_rng(4)
    made = [bent(*rng.uniform(-70, 70, 3)) for _ in range(50)]
    return np.array([body + rng.normal(0, 0.04, body.shape) for body in made])


# Known answers


def test_who_stands_straight_with_hanging_arms_has_every_angle_0():
    assert all(np.allclose(angle, 0, atol=1e-12) for angle in every_angle(standing()).values())


@pytest.mark.parametrize("flexion", [-30, 0, 20, 60, 90, 119, 170])
def test_a_trunk_bent_forward_is_flexed_by_as_much(flexion):
    assert np.allclose(trunk_deg(bent(flexion)), [flexion, 0, 0], atol=1e-9)
    assert np.rad2deg(trunk_flexion_rad(bent(flexion), CANONICAL)) == pytest.approx(flexion)


@pytest.mark.parametrize(
    ("flexion", "side", "twist"), [(0, 30, 0), (0, -30, 40), (45, 20, -25), (-20, 60, 15), (100, -40, 70)]
)
def test_flexion_side_bend_and_twist_come_back_together(flexion, side, twist):
    assert np.allclose(trunk_deg(bent(flexion, side, twist)), [flexion, side, twist], atol=1e-9)


def test_a_turn_to_the_left_twists_by_as_much_and_bends_nothing():
    assert np.allclose(trunk_deg(bent(twist=35)), [0, 0, 35], atol=1e-9)


def test_arms_forward_back_and_to_their_own_sides():
    body = arm(arm(standing(), "left", turn(Y, -70)), "right", turn(Y, 25))
    arms = upper_arm_angles(body, CANONICAL)
    assert np.allclose(np.rad2deg(arms.flexion_rad), [70, -25]) and np.allclose(
        np.rad2deg(arms.elevation_rad), [70, 25]
    )
    body = arm(arm(standing(), "left", turn(X, 60)), "right", turn(X, -80))
    arms = upper_arm_angles(body, CANONICAL)
    assert np.allclose(np.rad2deg(arms.abduction_rad), [60, 80]) and list(arms.abducted) == [False, True]


def test_an_arm_straight_up_is_elevated_by_180_degrees():
    arms = upper_arm_angles(arm(standing(), "left", turn(Y, -180)), CANONICAL)
    assert np.rad2deg(arms.elevation_rad[0]) == pytest.approx(180)


def test_arms_that_hang_in_a_stoop_are_flexed_against_the_trunk_and_not_against_gravity():
    body = arm(arm(bent(70), "left", turn(Y, -70)), "right", turn(Y, -70))
    assert np.allclose(np.rad2deg(upper_arm_angles(body, CANONICAL).flexion_rad), 70)
    assert np.allclose(upper_arm_angles(body, CANONICAL, "gravity").elevation_rad, 0, atol=1e-7)


def test_arms_are_measured_against_the_twisted_trunk():
    body = arm(bent(30, 10, 40), "left", np.eye(3))
    assert np.allclose(upper_arm_angles(body, CANONICAL).flexion_rad, 0, atol=1e-9)
    assert np.allclose(upper_arm_angles(body, CANONICAL).abduction_rad, 0, atol=1e-9)


def test_knees_elbows_and_wrists_bend_by_the_angle_between_their_bones():
    body = moved(standing(), turn(Y, 90), "left_knee", ["left_ankle", "left_toe"])
    body = moved(body, turn(Y, -110), "right_elbow", ["right_wrist", "right_hand"])
    body = moved(body, turn(X, 12), "left_wrist", ["left_hand"])
    assert np.allclose(np.rad2deg(knee_bend_rad(body, CANONICAL)), [90, 0])
    assert np.allclose(np.rad2deg(elbow_bend_rad(body, CANONICAL)), [0, 110])
    assert np.allclose(np.rad2deg(wrist_bend_rad(body, CANONICAL)), [12, 0])


def test_a_neck_is_flexed_against_the_trunk_and_its_neutral():
    nodding = moved(bent(40, 0, 20), turn(Y, 0), "neck", ["head"])
    assert np.allclose(neck_angles(nodding, CANONICAL).flexion_rad, 0, atol=1e-9)
    forward = moved(standing(), turn(Y, 18), "neck", ["head"])
    assert np.rad2deg(neck_angles(forward, CANONICAL).flexion_rad) == pytest.approx(18)
    neutral = neck_neutral_rad(np.array([forward, forward, standing()]), CANONICAL)
    assert neck_angles(forward, CANONICAL, neutral).flexion_rad == pytest.approx(0)


def test_small_bends_keep_their_digits():
    body = moved(standing(), turn(Y, np.rad2deg(1e-7)), "left_knee", ["left_ankle"])
    assert knee_bend_rad(body, CANONICAL)[0] == pytest.approx(1e-7, rel=1e-6)


def test_the_reference_skeletons_have_their_expected_angles():
    for case in json.loads(reference("ergonomic_cases.json").read_text())["skeleton"]:
        short = {"l_": "left_", "r_": "right_"}
        names = [short.get(name[:2], name[:2]) + name[2:] for name in case["joints_m"]]
        body = np.array(list(case["joints_m"].values()))
        trunk, neck = trunk_angles(body, names), neck_angles(body, names)
        arms, hanging = upper_arm_angles(body, names), upper_arm_angles(body, names, "gravity")
        found = {"trunk_flex": trunk.flexion_rad, "trunk_side": trunk.side_bend_rad, "trunk_twist": trunk.twist_rad}
        found |= {"neck_flex": neck.flexion_rad, "neck_side": neck.side_bend_rad}
        limbs = {"upper_arm_flex": arms.flexion_rad, "upper_arm_abd": arms.abduction_rad}
        limbs |= {"upper_arm_from_gravity": hanging.elevation_rad, "elbow_flex": elbow_bend_rad(body, names)}
        limbs |= {"knee_flex": knee_bend_rad(body, names), "wrist_flex_unsigned": wrist_bend_rad(body, names)}
        for name, both in limbs.items():
            found |= {f"l_{name}": both[0], f"r_{name}": both[1]}
        expected = case["expected_angles"]
        assert set(found) == set(expected)
        assert {name: np.rad2deg(angle) for name, angle in found.items()} == pytest.approx(expected, abs=0.011), case[
            "id"
        ]


# Laws


def test_angles_do_not_know_where_the_body_stands_nor_where_it_faces(anybody):
    rng = np.random.default_rng(5)
    elsewhere = np.einsum("nij,nkj->nki", [turn(Z, angle) for angle in rng.uniform(-180, 180, 50)], anybody)
    elsewhere += rng.uniform(-9, 9, (50, 1, 3))
    here, there = every_angle(anybody), every_angle(elsewhere)
    assert all(np.allclose(here[name], there[name], atol=1e-8) for name in here)


def test_angles_do_not_depend_on_size(anybody):
    here, large = every_angle(anybody), every_angle(1.2 * anybody)
    assert all(np.allclose(here[name], large[name], atol=1e-9) for name in here)


def test_a_mirrored_body_changes_sides(anybody):
    here, there = every_angle(anybody), every_angle(mirrored(anybody))
    for name, angle in here.items():
        expected = angle[:, ::-1] if angle.ndim == 2 else -angle if name.endswith(("side", "twist")) else angle
        assert np.allclose(there[name], expected, atol=1e-9), name


def test_leading_axes_are_kept_and_joints_may_come_in_any_order(anybody):
    order = np.random.default_rng(6).permutation(len(CANONICAL))
    one = trunk_angles(anybody.reshape(5, 10, 21, 3)[..., order, :], [CANONICAL[i] for i in order])
    assert one.twist_rad.shape == (5, 10)
    assert np.array_equal(one.twist_rad.ravel(), trunk_angles(anybody, CANONICAL).twist_rad)


def test_flexion_alone_is_the_flexion_of_all(anybody):
    assert np.allclose(trunk_flexion_rad(anybody, CANONICAL), trunk_angles(anybody, CANONICAL).flexion_rad, atol=1e-12)


# What has no answer


def test_with_the_hips_one_above_the_other_nobody_knows_what_is_forward():
    body = standing()
    body[[CANONICAL.index("left_hip"), CANONICAL.index("right_hip")]] = [[0, 0, 1.05], [0, 0, 0.85]]
    assert np.isnan(trunk_deg(body)).all()
    assert np.isnan(upper_arm_angles(body, CANONICAL, "gravity").flexion_rad).all()
    assert not np.isnan(upper_arm_angles(body, CANONICAL).flexion_rad).any()


def test_a_trunk_straight_sideways_has_a_side_bend_and_no_flexion():
    flexion, side, _ = trunk_deg(bent(0, 90))
    assert np.isnan(flexion) and side == pytest.approx(90)


def test_a_trunk_straight_down_has_a_flexion_and_no_twist():
    body = moved(
        standing(), turn(Y, 180), "pelvis", [name for name in CANONICAL if "shoulder" in name or name == "neck"]
    )
    flexion, side, twist = trunk_deg(body)
    assert abs(flexion) == pytest.approx(180) and side == pytest.approx(0, abs=1e-9) and np.isnan(twist)


def test_bones_without_length_have_no_angle_and_spoil_no_other_posture():
    bodies = np.array([standing(), bent(50)])
    bodies[0, CANONICAL.index("neck")] = bodies[0, CANONICAL.index("pelvis")]
    bodies[0, CANONICAL.index("left_elbow")] = bodies[0, CANONICAL.index("left_shoulder")]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        angles = trunk_angles(bodies, CANONICAL)
        assert np.isnan(angles.flexion_rad[0]) and np.rad2deg(angles.flexion_rad[1]) == pytest.approx(50)
        assert np.isnan(elbow_bend_rad(bodies, CANONICAL)[0]).tolist() == [True, False]


def test_shoulders_along_the_trunk_have_no_twist():
    body = standing()
    body[[CANONICAL.index("left_shoulder"), CANONICAL.index("right_shoulder")]] = [[0, 0, 1.5], [0, 0, 1.3]]
    assert np.isnan(trunk_angles(body, CANONICAL).twist_rad)
    assert np.isnan(upper_arm_angles(body, CANONICAL).flexion_rad).all()


def test_a_joint_that_is_not_finite_gives_nan():
    body = standing()
    body[CANONICAL.index("neck"), 0] = np.nan
    assert np.isnan(trunk_deg(body)).all()


def test_a_missing_joint_is_named_with_the_nearest_that_is_there():
    names = [name.replace("left_hip", "left_hips") for name in CANONICAL]
    with pytest.raises(ValueError, match="no joint 'left_hip'; did you mean 'left_hips'"):
        trunk_angles(standing(), names)


def test_positions_of_another_shape_are_refused():
    with pytest.raises(ValueError, match=r"must be \(\.\.\., 21, 3\), found \(21, 2\)"):
        trunk_angles(standing()[:, :2], CANONICAL)


def test_an_unknown_reference_is_refused_with_the_nearest_word():
    with pytest.raises(ValueError, match="did you mean 'gravity'"):
        upper_arm_angles(standing(), CANONICAL, "gravitty")
