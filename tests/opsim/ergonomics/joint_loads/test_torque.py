from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.anthropometry import FEMALE, MALE, segments_of, strength_nm
from opsim.ergonomics.joint_loads import JOINTS, G, shares, torques_nm
from opsim.subjects.human import muscle_fatigue as three_compartment

MAN = SimpleNamespace(height_m=1.75, mass_kg=80.0, age_years=40.0, sex="m")
AT = {name: place for place, name in enumerate(JOINTS)}


def stood(arms="hanging", trunk_rad=0.0):
    """Joints of a made body: arms hang or reach forward, the trunk bends at the pelvis."""
    up = np.array([np.sin(trunk_rad), 0.0, np.cos(trunk_rad)])
    joints = {"pelvis": np.array([0.0, 0.0, 1.0])}
    joints["neck"] = joints["pelvis"] + 0.5 * up
    joints["head"] = joints["neck"] + 0.2 * up
    along = np.array([1.0, 0.0, 0.0]) if arms == "forward" else np.array([0.0, 0.0, -1.0])
    for side, y in (("left", 0.2), ("right", -0.2)):
        shoulder = joints["neck"] + [0.0, y, 0.0]
        joints[f"{side}_shoulder"], joints[f"{side}_elbow"] = shoulder, shoulder + 0.30 * along
        joints[f"{side}_wrist"], joints[f"{side}_hand"] = shoulder + 0.55 * along, shoulder + 0.65 * along
        joints[f"{side}_hip"] = joints["pelvis"] + [0.0, y / 2, 0.0]
        joints[f"{side}_knee"] = joints[f"{side}_hip"] - [0.0, 0.0, 0.45]
    return np.array(list(joints.values())), tuple(joints)


def test_an_arm_held_out_with_two_and_a_half_kilograms_by_hand():
    # 80 kg: upper arm 2.168 kg at 0.5772 * 0.30 = 0.17316 m; forearm 1.296 kg at 0.30 + 0.4574 * 0.25 = 0.41435 m;
    # hand 0.488 kg at 0.55 + 0.79 * 0.10 = 0.629 m; load 2.5 kg at 0.65 m
    # shoulder: 9.80665 * (0.375411 + 0.536998 + 0.306952 + 1.625) = 27.89365
    # elbow: 9.80665 * (1.296 * 0.11435 + 0.488 * 0.329 + 2.5 * 0.35) = 11.60862
    found = torques_nm(*stood("forward"), body=MAN, load_kg=5.0)
    assert found[[AT["left_shoulder"], AT["right_shoulder"]]] == pytest.approx(27.89365, abs=1e-5)
    assert found[[AT["left_elbow"], AT["right_elbow"]]] == pytest.approx(11.60862, abs=1e-5)


def test_who_stands_upright_with_hanging_arms_is_asked_for_nothing():
    assert torques_nm(*stood(), body=MAN) == pytest.approx(np.zeros(7), abs=1e-9)


def test_a_back_bent_by_thirty_degrees_by_hand():
    # half a metre of trunk at 30 degrees: neck 0.25 m ahead, head 0.35 m, arms hang from 0.25 m
    # 80 kg: back 25.832 kg at 0.6153 * 0.25 = 0.153825 m; head 5.552 kg at 0.35 m; both arms 7.904 kg at 0.25 m
    # 9.80665 * (3.973607 + 1.9432 + 1.976) = 77.4020; hips: all the trunk 34.768 kg at 0.4862 * 0.25 = 0.12155 m:
    # 9.80665 * (4.226050 + 1.9432 + 1.976) / 2 = 39.9388 each
    found = torques_nm(*stood("hanging", np.pi / 6), body=MAN)
    assert found[AT["back"]] == pytest.approx(77.4020, abs=1e-3)
    assert found[AT["hips"]] == pytest.approx(39.9388, abs=1e-3)


def test_shares_are_of_ones_own_strength():
    # elbow flexion of a man of 40 years, 1.75 m, 80 kg: -23.8 - 0.13 * 40 + 22 * 1.75 + 0.51 * 80 = 50.3 Nm
    assert strength_nm("elbow", MAN) == pytest.approx(50.3)
    found = shares(torques_nm(*stood("forward"), body=MAN, load_kg=5.0), MAN)
    assert found[AT["left_elbow"]] == pytest.approx(11.60862 / 50.3, abs=1e-6)
    assert found.max() <= 1.0


def test_an_unknown_sex_is_half_of_each():
    body = SimpleNamespace(height_m=1.7, mass_kg=70.0, age_years=30.0)
    of = [strength_nm("knee", SimpleNamespace(**vars(body), sex=sex)) for sex in ("m", "f", None)]
    assert of[2] == pytest.approx((of[0] + of[1]) / 2)
    assert segments_of(None).head == pytest.approx((MALE.head + FEMALE.head) / 2)


@given(st.floats(0.0, 40.0), st.floats(0.0, 20.0), st.floats(0.0, 1.5))
def test_more_load_asks_more_of_every_joint_of_who_reaches_forward(load_kg, more_kg, bent):
    at = stood("forward", bent)
    assert np.all(torques_nm(*at, MAN, load_kg + more_kg) >= torques_nm(*at, MAN, load_kg) - 1e-9)


def test_turning_the_body_changes_nothing():
    positions, names = stood("forward", 0.4)
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    assert torques_nm(positions @ turn.T, names, MAN, 3.0) == pytest.approx(torques_nm(positions, names, MAN, 3.0))


def test_what_joints_do_not_tell_is_nan():
    positions, names = stood("forward")
    keep = [place for place, name in enumerate(names) if name != "left_elbow"]
    found = torques_nm(positions[keep], [names[place] for place in keep], MAN)
    assert np.isnan(found[[AT["left_shoulder"], AT["left_elbow"], AT["back"]]]).all()
    assert np.isfinite(found[[AT["right_shoulder"], AT["right_elbow"]]]).all()


def test_a_held_out_arm_is_near_what_was_measured_of_it():
    """96 men of Stockholm needed 22 to 25 % of the strength of their shoulder flexors for it ("Isometric strength in
    flexors, abductors and external rotators of the shoulder", abstract); ours is 17 % of abduction strength."""
    arm = {"shoulder": 0.0, "elbow": 0.282, "wrist": 0.551, "hand": 0.637}
    names = [f"left_{name}" for name in arm]
    positions = np.array([[x, 0.0, 1.4] for x in arm.values()])
    share = shares(torques_nm(positions, names, MAN), MAN)[AT["left_shoulder"]]
    assert 0.12 < share < 0.25


def test_weights_are_on_earth_and_joints_in_the_order_of_the_muscles():
    assert G == 9.80665
    assert tuple(three_compartment.JOINTS) == JOINTS
