"""REBA by hand: every table looked up in the paper's print, the arithmetic beside it."""

import pytest

from opsim.ergonomics.scores.reba import knee_score, reba, reba_neck_score, reba_trunk_score, reba_wrist_score

NEUTRAL = {"neck_flex": 5, "trunk_flex": 0, "upper_arm_flex": 0, "elbow_flex": 80, "wrist_flex": 0}


def test_everything_neutral_is_1():
    found = reba(**NEUTRAL)
    assert (found.table_a, found.table_b, found.score_c, found.reba, found.action_level) == (1, 1, 1, 1, 0)


def test_a_lift_from_a_half_squat_is_9():
    # neck 25: 2; trunk 30: 3; knee 40: legs 2; A (2, 3, 2) 5, 7 kg: 6. Upper arm 50: 3; elbow 50: 2; wrist 10: 1:
    # B (3, 2, 1) 4, fair grip: 5. C (6, 5) 8; repeated: 9: high
    found = reba(neck_flex=25, trunk_flex=30, knee_flex=40, upper_arm_flex=50, elbow_flex=50, wrist_flex=10, load_kg=7,
                 coupling=1, activity=1)  # fmt: skip
    assert (found.table_a, found.score_a, found.table_b, found.score_b) == (5, 6, 4, 5)
    assert (found.score_c, found.reba, found.action_level) == (8, 9, 3)


def test_the_worst_of_everything_is_15():
    # neck 3, trunk 5, legs 4: A 9, + 3: 12. Upper arm 6, lower 2, wrist 3: B 9, + 3: 12. C 12 + 3
    found = reba(neck_flex=-10, neck_twisted=1, trunk_flex=70, trunk_side_bent=1, knee_flex=70, bilateral=0,
                 upper_arm_flex=120, upper_arm_abducted_or_rotated=1, shoulder_raised=1, elbow_flex=10, wrist_flex=40,
                 wrist_dev_or_twisted=1, load_kg=15, shock=1, coupling=3, activity=3)  # fmt: skip
    assert (found.table_a, found.score_a, found.table_b, found.score_b, found.reba) == (9, 12, 9, 12, 15)
    assert found.action_level == 4


def test_twisting_and_side_bending_add_one_together():
    assert reba(**NEUTRAL, trunk_twisted=1, trunk_side_bent=1).trunk == reba(**NEUTRAL, trunk_twisted=1).trunk == 2
    assert reba(**NEUTRAL, neck_twisted=1, neck_side_bent=1).neck == reba(**NEUTRAL, neck_side_bent=1).neck == 2


def test_the_knees_of_a_sitter_do_not_count():
    assert (
        reba(**NEUTRAL, knee_flex=90).legs == 3 and reba(**NEUTRAL, knee_flex=90, sitting=True, bilateral=0).legs == 1
    )


def test_edges_are_as_in_the_paper():
    assert [knee_score(a) for a in (29, 30, 60, 61)] == [0, 1, 1, 2]
    assert [reba_neck_score(a) for a in (-1, 0, 20, 21)] == [2, 1, 1, 2]
    assert [reba_trunk_score(a) for a in (-61, -21, -20, 0, 1, 20, 21, 60, 61)] == [3, 3, 2, 1, 2, 2, 3, 3, 4]
    assert [reba_wrist_score(a) for a in (-16, -15, 0, 15, 16)] == [2, 1, 1, 1, 2]


def test_all_that_is_wrong_is_said_at_once():
    with pytest.raises(ValueError) as told:
        reba(**{**NEUTRAL, "elbow_flex": None}, load_kg=float("inf"), coupling=4, activity=-1)
    assert str(told.value).splitlines() == [
        "elbow_flex: found nothing, expected a number",
        "load_kg: found inf, expected a number",
        "coupling: found 4, expected one of 0, 1, 2, 3",
        "activity: found -1, expected one of 0, 1, 2, 3",
    ]
