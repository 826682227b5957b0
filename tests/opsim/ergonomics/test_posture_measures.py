import json
import warnings
from dataclasses import replace

import numpy as np
import pytest
from recordings import reference

from opsim.ergonomics.angles import ANGLES, AT, CANONICAL, COLUMNS, LENGTHS
from opsim.ergonomics.measures import measures_of_joints, measures_of_positions
from opsim.ergonomics.options import USUAL
from tests.opsim.ergonomics.bodies import arm, bent, mirrored, moved, standing, turn
from tests.opsim.ergonomics.built import CASES, NAMES, built

X, Y, Z = np.eye(3)
WAYS = [measures_of_positions, measures_of_joints]
GRAVITY = replace(USUAL, arm_reference="gravity")
BOTH = pytest.mark.parametrize("measured", WAYS)


def named(measures):
    return dict(zip(COLUMNS, measures, strict=True))


@pytest.fixture(scope="module")
def anybody():
    """Two hundred bodies (200, 21, 3) in no posture that has a name."""
    rng = np.random.default_rng(8)
    made = [bent(*rng.uniform(-170, 170, 3)) for _ in range(200)]
    return np.array([body + rng.normal(0, 0.08, body.shape) for body in made])


# Known answers


@BOTH
@pytest.mark.parametrize("case", CASES)
def test_a_body_built_from_angles_has_them(measured, case):
    said = {"trunk": 0, "neck": 0, "twist": 0, "arm": 0, "abduction": 0, "elbow": 0, "wrist": 0, "knee": 0} | CASES[
        case
    ]
    found = named(measured(built(**said), NAMES))
    expected = {"trunk_flexion": said["trunk"], "trunk_side": 0, "trunk_twist": said["twist"]}
    expected |= {"neck_flexion": said["neck"], "neck_side": 0}
    of_both = {"arm_flexion": "arm", "arm_abduction": "abduction", "elbow": "elbow", "wrist": "wrist", "knee": "knee"}
    expected |= {f"{side}_{name}": said[angle] for name, angle in of_both.items() for side in ("left", "right")}
    assert {name: found[name] for name in expected} == pytest.approx(expected, abs=1e-6)


@BOTH
def test_elevation_is_against_gravity_whatever_the_reference(measured):
    """A stoop of 70 with arms flexed by 70: they hang. Bent by 45 and twisted by 25 with arms at 50, 19.02 by the case
    of reference: cos = cos 50 cos 45 + cos 25 sin 50 sin 45."""
    assert named(measured(built(trunk=70, arm=70), NAMES))["left_arm_elevation"] == pytest.approx(0, abs=1e-6)
    a, b, c = np.deg2rad([50, 45, 25])
    expected = np.rad2deg(np.arccos(np.cos(a) * np.cos(b) + np.cos(c) * np.sin(a) * np.sin(b)))
    for options in (USUAL, GRAVITY):
        found = named(measured(built(trunk=45, twist=25, arm=50), NAMES, options))
        assert expected == pytest.approx(19.02, abs=0.02) and found["right_arm_elevation"] == pytest.approx(expected)


@BOTH
def test_arms_are_flexed_against_what_is_asked_for(measured):
    stoop = built(trunk=70, arm=70)
    assert named(measured(stoop, NAMES, GRAVITY))["left_arm_flexion"] == pytest.approx(0, abs=1e-6)
    assert named(measured(stoop, NAMES))["left_arm_flexion"] == pytest.approx(70)
    with pytest.raises(ValueError, match="did you mean 'gravity'"):
        measured(stoop, NAMES, replace(USUAL, arm_reference="gravitty"))


@BOTH
def test_necks_are_flexed_from_their_neutral(measured):
    assert named(measured(built(neck=30), NAMES, USUAL, np.deg2rad(12)))["neck_flexion"] == pytest.approx(18)


@BOTH
def test_lengths_of_who_stands_with_hanging_arms(measured):
    """Ankles lie at 0.05 m and so do toes; elbows 0.29 m under shoulders 0.19 m from the midline."""
    found = named(measured(built(), NAMES))
    expected = {
        "elbow_above_m": -0.29,
        "across_m": -0.19,
        "outside_m": 0.0,
        "hand_up_m": 0.73 - 0.05,
        "ankle_up_m": 0.0,
    }
    expected = {f"{side}_{name}": value for name, value in expected.items() for side in ("left", "right")}
    expected |= {"hands_forward_m": 0.0, "hands_left_m": 0.0, "pelvis_up_m": 0.86}
    assert set(expected) == set(LENGTHS) and {name: found[name] for name in expected} == pytest.approx(expected)


@BOTH
def test_a_hand_across_the_midline_is_inside_its_shoulder(measured):
    """The left arm, 0.64 m to the hand, turned inwards by 30 degrees: 0.2 - 0.64 sin 30 = -0.12 m."""
    found = named(measured(arm(standing(), "left", turn(X, -30)), CANONICAL))
    assert found["left_across_m"] == pytest.approx(0.12) and found["left_outside_m"] == pytest.approx(-0.32)
    assert found["right_across_m"] == pytest.approx(-0.2) and found["right_outside_m"] == pytest.approx(0, abs=1e-12)


@BOTH
def test_a_reach_is_from_the_ankles_in_the_frame_of_the_body(measured):
    """Both arms straight forward: shoulders at x = 0, hands 0.64 m on; ankles at x = 0. Facing y it is the same."""
    body = arm(arm(standing(), "left", turn(Y, -90)), "right", turn(Y, -90))
    for facing in (body, body @ turn(Z, 90).T):
        found = named(measured(facing, CANONICAL))
        assert found["hands_forward_m"] == pytest.approx(0.64) and found["hands_left_m"] == pytest.approx(0, abs=1e-12)
    aside = body + np.array([0.0, 0.3, 0.0]) * np.isin(CANONICAL, ["left_hand", "right_hand"])[:, None]
    assert named(measured(aside, CANONICAL))["hands_left_m"] == pytest.approx(0.3)


@BOTH
def test_the_floor_is_the_lowest_foot(measured):
    """A foot lifted by 0.3 m changes no other height; standing toes lie at 0.02 m, hands at 0.76 m."""
    body = standing()
    lifted = body + np.array([0.0, 0.0, 0.3]) * np.isin(CANONICAL, ["left_ankle", "left_toe"])[:, None]
    found = named(measured(lifted, CANONICAL))
    assert found["left_ankle_up_m"] == pytest.approx(0.35) and found["right_ankle_up_m"] == pytest.approx(0.05)
    assert found["right_hand_up_m"] == pytest.approx(0.74)


@BOTH
def test_the_reference_skeletons_have_their_expected_angles(measured):
    for case in json.loads(reference("ergonomic_cases.json").read_text())["skeleton"]:
        short = {"l_": "left_", "r_": "right_"}
        names = [short.get(name[:2], name[:2]) + name[2:] for name in case["joints_m"]]
        found = named(measured(np.array(list(case["joints_m"].values())), names))
        for name, expected in case["expected_angles"].items():
            assert found[_ours(name)] == pytest.approx(expected, abs=0.011), (case["id"], name)


def _ours(name):
    """``l_upper_arm_flex`` of the reference is ``left_arm_flexion`` here."""
    side = {"l_": "left_", "r_": "right_"}.get(name[:2], "")
    rest = name[2:] if side else name
    words = {"upper_arm_from_gravity": "arm_elevation", "upper_arm_flex": "arm_flexion"}
    words |= {"upper_arm_abd": "arm_abduction", "elbow_flex": "elbow", "wrist_flex_unsigned": "wrist"}
    words |= {"knee_flex": "knee", "trunk_flex": "trunk_flexion", "neck_flex": "neck_flexion"}
    return side + words.get(rest, rest)


# The kernel and its twin


@pytest.mark.parametrize("options", [USUAL, GRAVITY])
def test_the_kernel_is_the_naive_way(anybody, options):
    naive = measures_of_positions(anybody, CANONICAL, options, 0.2)
    assert np.allclose(measures_of_joints(anybody, CANONICAL, options, 0.2), naive, rtol=0, atol=1e-9, equal_nan=True)
    assert not np.isnan(naive).any()


def test_leading_axes_and_the_order_of_joints_are_the_callers(anybody):
    order = np.random.default_rng(2).permutation(len(CANONICAL))
    found = measures_of_joints(anybody.reshape(10, 20, 21, 3)[..., order, :], [CANONICAL[joint] for joint in order])
    assert np.array_equal(found.reshape(200, -1), measures_of_joints(anybody, CANONICAL))


# Laws


def test_measures_do_not_know_where_the_body_stands_nor_where_it_faces(anybody):
    rng = np.random.default_rng(5)
    turns = np.array([turn(Z, angle) for angle in rng.uniform(-180, 180, len(anybody))])
    elsewhere = np.einsum("nij,nkj->nki", turns, anybody) + rng.uniform(-9, 9, (len(anybody), 1, 3))
    assert np.allclose(measures_of_joints(elsewhere, CANONICAL), measures_of_joints(anybody, CANONICAL), atol=1e-7)


@pytest.mark.parametrize("options", [USUAL, GRAVITY])
def test_a_mirrored_body_changes_sides(anybody, options):
    here, there = (measures_of_joints(body, CANONICAL, options) for body in (anybody, mirrored(anybody)))
    turned_round = ("trunk_side", "trunk_twist", "neck_side", "hands_left_m")
    for name in COLUMNS:
        other = name.replace("left_", "*").replace("right_", "left_").replace("*", "right_")
        expected = -here[:, AT[name]] if name in turned_round else here[:, AT[other]]
        assert np.allclose(there[:, AT[name]], expected, atol=1e-7), name


def test_a_larger_body_has_the_same_angles_and_longer_lengths(anybody):
    here, large = (measures_of_joints(size * anybody, CANONICAL) for size in (1.0, 1.25))
    factor = np.where(np.arange(len(COLUMNS)) < len(ANGLES), 1.0, 1.25)
    assert np.allclose(large, factor * here, atol=1e-7)


# What has no answer


@pytest.mark.parametrize("gone", CANONICAL)
@pytest.mark.parametrize("options", [USUAL, GRAVITY])
def test_without_a_joint_both_ways_lack_the_same_measures(anybody, gone, options):
    names = [name for name in CANONICAL if name != gone]
    here = anybody[:5, [CANONICAL.index(name) for name in names]]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        naive, fast = (measured(here, names, options) for measured in WAYS)
    assert np.allclose(naive, fast, atol=1e-9, equal_nan=True)
    assert np.isnan(naive).all(axis=0).tolist() == np.isnan(naive).any(axis=0).tolist()


@BOTH
def test_a_skeleton_without_wrists_hands_or_head_keeps_what_it_shows(measured):
    names = [name for name in CANONICAL if not name.endswith(("wrist", "hand", "head"))]
    found = named(measured(standing()[[CANONICAL.index(name) for name in names]], names))
    gone = {name for name, value in found.items() if np.isnan(value)}
    of_arms = {
        f"{side}_{name}"
        for side in ("left", "right")
        for name in ("elbow", "wrist", "across_m", "outside_m", "hand_up_m")
    }
    assert gone == of_arms | {"neck_flexion", "neck_side", "hands_forward_m", "hands_left_m"}


@BOTH
def test_a_wrist_stands_for_a_hand_that_is_missing(measured):
    names = [name for name in CANONICAL if not name.endswith("hand")]
    found = named(measured(standing()[[CANONICAL.index(name) for name in names]], names))
    assert found["left_hand_up_m"] == pytest.approx(0.85 - 0.02) and np.isnan(found["left_wrist"])


@BOTH
def test_what_has_no_direction_is_nan_and_spoils_no_other_posture(measured, anybody):
    bodies = anybody[:6].copy()
    hips, shoulders = ["left_hip", "right_hip"], ["left_shoulder", "right_shoulder"]
    bodies[0, [CANONICAL.index(name) for name in hips]] = [[0, 0, 1.0], [0, 0, 0.8]]
    bodies[1, CANONICAL.index("neck")] = bodies[1, CANONICAL.index("pelvis")]
    bodies[2, CANONICAL.index("left_elbow")] = bodies[2, CANONICAL.index("left_shoulder")]
    bodies[3] = np.nan
    bodies[4] = moved(standing(), turn(Y, 180), "pelvis", [*shoulders, "neck"])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = measured(bodies, CANONICAL)
    assert np.allclose(found, measures_of_positions(bodies, CANONICAL), atol=1e-9, equal_nan=True)
    assert np.isnan(found[0, [AT["trunk_flexion"], AT["hands_forward_m"]]]).all() and np.isnan(found[3]).all()
    assert np.isnan(found[1, AT["trunk_flexion"]]) and np.isnan(found[2, AT["left_elbow"]])
    assert np.isnan(found[4, AT["trunk_twist"]]) and not np.isnan(found[5]).any()


@BOTH
def test_a_trunk_straight_sideways_has_a_side_bend_and_no_flexion(measured):
    found = named(measured(bent(0, 90), CANONICAL))
    assert np.isnan(found["trunk_flexion"]) and found["trunk_side"] == pytest.approx(90)
    up = arm(standing(), "left", turn(X, 90))
    assert np.isnan(named(measured(up, CANONICAL))["left_arm_flexion"])


@BOTH
def test_shoulders_along_the_trunk_have_no_twist(measured):
    body = standing()
    body[[CANONICAL.index("left_shoulder"), CANONICAL.index("right_shoulder")]] = [[0, 0, 1.5], [0, 0, 1.3]]
    found = named(measured(body, CANONICAL))
    assert np.isnan(found["trunk_twist"]) and np.isnan(found["left_arm_flexion"]) and found["left_arm_elevation"] >= 0


@BOTH
def test_one_joint_that_is_nan_costs_only_what_needs_it(measured):
    body = standing()
    body[CANONICAL.index("left_wrist"), 1] = np.nan
    found = named(measured(body, CANONICAL))
    assert {name for name in ANGLES if np.isnan(found[name])} == {"left_elbow", "left_wrist"}
    assert not any(np.isnan(found[name]) for name in LENGTHS)


@BOTH
def test_positions_of_another_shape_are_refused(measured):
    with pytest.raises(ValueError, match=r"must be \(\.\.\., 21, 3\), found \(21, 2\)"):
        measured(standing()[:, :2], CANONICAL)


@BOTH
def test_no_postures_have_no_measures(measured):
    assert measured(np.empty((0, 21, 3)), CANONICAL).shape == (0, len(COLUMNS))
