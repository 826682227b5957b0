"""Zones of EN 1005-4 and movements a minute."""

import numpy as np

from opsim.ergonomics.strain.posture_limits import CONDITIONAL, NOT_RECOMMENDED, per_minute, verdicts, zoned_angles_deg
from tests.opsim.ergonomics.made_frames import made_frames

MINUTE_S, NEVER = np.arange(60.0), np.zeros(60, bool)


def test_movements_are_counted_by_the_minute_of_the_clock():
    start_s = np.array([0.0, 30.0, 59.9, 60.0, 130.0])
    assert per_minute(np.array([True, True, False, True, False]), start_s).tolist() == [2, 2, 2, 1, 0]


def test_who_stands_upright_is_accepted_a_degree_backward_too():
    """57 s at -1 degree and three bends of a second to 25: the bends are too often, standing is not."""
    angle = np.full(60, -1.0)
    angle[[10, 30, 50]] = 25.0
    for region in ("trunk", "neck"):
        found = verdicts(angle, NEVER, MINUTE_S, region)
        assert (found == NOT_RECOMMENDED).sum() == (3 if region == "trunk" else 0)
        assert not found[angle < 0].any()


def test_each_zone_has_the_frequency_of_the_movements_into_it():
    """Back once, and three bends to 40: bending is too often, leaning back is not."""
    angle = np.zeros(60)
    angle[[10, 20, 30]], angle[40:50] = 40.0, -10.0
    found = verdicts(angle, NEVER, MINUTE_S, "trunk")
    assert (found[[10, 20, 30]] == NOT_RECOMMENDED).all() and (found[40:50] == CONDITIONAL).all()
    twice = angle.copy()
    twice[52:] = -10.0
    assert (verdicts(twice, NEVER, MINUTE_S, "trunk")[40:50] == NOT_RECOMMENDED).all()


def test_from_40_degrees_to_70_again_and_again_is_often_in_zone_3_and_seldom_in_zone_2():
    angle = np.full(60, 40.0)
    angle[[10, 20, 30]] = 70.0
    found = verdicts(angle, NEVER, MINUTE_S, "trunk")
    assert (found == NOT_RECOMMENDED).tolist() == (angle == 70.0).tolist()


def test_who_bends_twice_and_deep_once_is_seldom_in_zone_3():
    angle = np.zeros(60)
    angle[[10, 20]], angle[30] = 40.0, 70.0
    found = verdicts(angle, NEVER, MINUTE_S, "trunk")
    assert found[30] == CONDITIONAL and (found[[10, 20]] == NOT_RECOMMENDED).all()


def test_an_arm_is_behind_the_trunk_by_its_flexion():
    frames = made_frames(60, left_arm_elevation=30.0, left_arm_flexion=-30.0, right_arm_elevation=30.0)
    angles = zoned_angles_deg(frames.measures)
    assert (angles["left_arm"] == -30.0).all() and (angles["right_arm"] == 30.0).all()
    assert (verdicts(angles["left_arm"], NEVER, MINUTE_S, "left_arm") == CONDITIONAL).all()
    assert (verdicts(angles["left_arm"], ~NEVER, MINUTE_S, "left_arm") == NOT_RECOMMENDED).all()
    assert (verdicts(angles["right_arm"], ~NEVER, MINUTE_S, "right_arm") == CONDITIONAL).all()


def test_arms_that_rise_once_a_minute_are_accepted_and_twice_above_60_are_not():
    once, twice = np.zeros(60), np.zeros(60)
    once[10:14], twice[10:14], twice[30:34] = 70.0, 70.0, 70.0
    never, start_s = np.zeros(60, bool), np.arange(60.0)
    for angle, n in ((once, 0), (twice, 8)):
        assert (verdicts(angle, never, start_s, "left_arm") == 2).sum() == n


def test_arms_in_zone_2_become_too_much_ten_times_a_minute():
    start_s, never = np.arange(60.0), np.zeros(60, bool)
    for times, n in ((9, 0), (10, 10)):
        angle = np.zeros(60)
        angle[np.arange(times) * 5] = 40.0
        assert (verdicts(angle, never, start_s, "right_arm") == 2).sum() == n
