import json
import warnings
from dataclasses import dataclass, fields, replace
from types import SimpleNamespace

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
from opsim.ergonomics.options import CHOICES, PAPER, RANGES, USUAL, Options, Thresholds, checked
from opsim.ergonomics.redraw import neck_neutral_rad as neck_neutral_rad_of_neutral
from opsim.ergonomics.redraw import neck_neutrals_rad
from opsim.libraries import load_library
from opsim.shipped import shipped_folder
from opsim.tasks import Fixed
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


@dataclass(frozen=True)
class Starts:
    """Performances that begin with these necks (n,) and trunks (n,), in degrees; a task model of itself."""

    neck_deg: tuple[float, ...]
    trunk_deg: tuple[float, ...]
    report: object = None
    skeleton = SimpleNamespace(names=CANONICAL)

    @property
    def duration_s(self):
        return np.ones(len(self.neck_deg))

    def positions_m(self, n_times):
        lean = [turn([0, 1, 0], neck) for neck in self.neck_deg]
        first = [moved(bent(trunk), way, "neck", ["head"]) for trunk, way in zip(self.trunk_deg, lean)]
        return np.repeat(np.array(first)[:, None], n_times, axis=1)


class Model(Starts):
    def sample(self, n, rng, *, worker=None, condition=None):
        return Starts(self.neck_deg, self.trunk_deg)


def degrees(**models):
    return {task: round(float(np.rad2deg(angle)), 9) for task, angle in neck_neutrals_rad(models).items()}


def test_the_neutral_is_the_median_of_those_that_begin_upright():
    starts = Starts((12.0, 18.0, 14.0, 60.0), (0.0, 10.0, -14.0, 40.0))
    assert np.rad2deg(neck_neutral_rad_of_neutral(starts)) == pytest.approx(14.0)
    assert neck_neutral_rad_of_neutral(Model(starts.neck_deg, starts.trunk_deg)) == neck_neutral_rad_of_neutral(starts)


def test_where_most_begin_bent_it_cannot_be_told():
    assert neck_neutral_rad_of_neutral(Starts((12.0, 18.0, 20.0), (0.0, 30.0, 40.0))) == 0.0


def test_times_without_a_body_have_none():
    assert degrees(count=Fixed(3.0)) == {"count": 0.0}


def test_tasks_of_the_same_recordings_share_the_median_of_theirs():
    one, other = SimpleNamespace(source="lab"), SimpleNamespace(source="plant")
    tasks = {"reach": Model((10.0,), (0.0,), one), "fasten": Model((30.0,), (0.0,), one)}
    tasks |= {"place": Model((14.0,), (0.0,), one), "stoop": Model((5.0,), (70.0,), one)}
    found = degrees(**tasks, lift=Model((20.0,), (0.0,), other), count=Fixed(3.0))
    assert found == {"reach": 14.0, "fasten": 14.0, "place": 14.0, "stoop": 14.0, "lift": 20.0, "count": 0.0}


def test_made_work_stands_with_the_head_it_was_made_with_every_time():
    """Key postures of made tasks that look ahead have the head 16.5 degrees forward."""
    library = load_library(shipped_folder() / "libraries" / "bench_work.npz")
    found = degrees(pick=library["pick"], reach=library["reach"])
    assert found["pick"] == found["reach"] == pytest.approx(16.5, abs=0.1)
    assert found == degrees(reach=library["reach"], pick=library["pick"])


def test_what_is_usual_is_right_and_comes_back_itself():
    assert checked(USUAL) is USUAL and checked(Options(thresholds=PAPER)).thresholds is PAPER


def test_every_number_has_a_range_and_every_word_its_choices():
    numbers = {one.name for one in fields(Thresholds) if one.name != "spread"} | {"rate_hz"}
    assert numbers == set(RANGES)
    words = {one.name for one in fields(Options) if isinstance(getattr(USUAL, one.name), str)}
    assert words == set(CHOICES)


@pytest.mark.parametrize("name", RANGES)
def test_each_range_ends_where_it_says(name):
    def said(value):
        one = replace(USUAL if name == "rate_hz" else USUAL.thresholds, **{name: value})
        return one if name == "rate_hz" else replace(USUAL, thresholds=one)

    low, high = RANGES[name]
    assert checked(said(low)) and checked(said(high))
    for wrong in (low - 0.01, high + 0.01, float("nan"), True, "10 deg", None):
        with pytest.raises(ValueError, match=rf"{name}: found .+, expected {low:g} to {high:g}"):
            checked(said(wrong))


def test_all_mistakes_are_said_at_once_with_the_nearest_word():
    thresholds = Thresholds(twist=91.0, abducted=95.0, owas_back=-5.0, trunk_upright=25.0, spread="yes")
    wrong = Options(0.0, "gravty", "worksheet2001", "papers", ("3373", "4133"), "upright!", thresholds)
    with pytest.raises(ValueError) as told:
        checked(wrong)
    assert str(told.value).splitlines() == [
        "arm_reference: no 'gravty'; did you mean 'gravity'?",
        "rula_table_a: no 'worksheet2001'; did you mean 'worksheet2000'?",
        "rula_force: no 'papers'; did you mean 'paper'?",
        "waiting: no 'upright!'; did you mean 'upright'?",
        "owas_disputed: no disputed code '4133'; did you mean '4132'?",
        "rate_hz: found 0.0, expected 1 to 60 a second",
        "thresholds.twist: found 91.0, expected 1 to 90 degrees",
        "thresholds.abducted: found 95.0, expected 1 to 90 degrees",
        "thresholds.trunk_upright: found 25.0, expected 0 to 20 degrees",
        "thresholds.owas_back: found -5.0, expected 1 to 90 degrees",
        "thresholds.spread: found 'yes', expected true or false",
    ]
