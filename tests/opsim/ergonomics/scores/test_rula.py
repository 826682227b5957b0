"""RULA by hand: every table looked up in the paper's print, the arithmetic beside it."""

import pytest

from opsim.ergonomics.options import Thresholds
from opsim.ergonomics.scores.rula import neck_score, rula, trunk_score, upper_arm_score, wrist_score

NEUTRAL = {"upper_arm_flex": 0, "elbow_flex": 80, "wrist_flex": 0, "neck_flex": 5, "trunk_flex": 0}


def test_everything_neutral_is_1():
    # A (1, 1, 1, 1) 1; B (1, 1, 1) 1; C (1, 1) 1: acceptable
    found = rula(**NEUTRAL)
    assert (found.table_a, found.table_b, found.score_c, found.score_d, found.grand, found.action_level) == (1,) * 6


def test_a_bench_worker_who_reaches_and_leans_a_little_is_3():
    # upper arm 30: 2; elbow 80: 1; wrist 10: 2; A (2, 1, 2, 1) 3. Neck 15: 2; trunk 10: 2; B (2, 2, 1) 2. C (3, 2) 3
    found = rula(upper_arm_flex=30, elbow_flex=80, wrist_flex=10, neck_flex=15, trunk_flex=10)
    assert (found.table_a, found.table_b, found.grand, found.action_level) == (3, 2, 3, 2)


def test_muscle_use_adds_to_both_halves():
    # as above: C (3 + 1, 2 + 1) is 3; with 5 kg repeated, 2 more on both: C (6, 5) 6: soon
    bench = {"upper_arm_flex": 30, "elbow_flex": 80, "wrist_flex": 10, "neck_flex": 15, "trunk_flex": 10}
    assert rula(**bench, muscle_use=True).grand == 3
    found = rula(**bench, muscle_use=True, force_kg=5, force_pattern="repeated")
    assert (found.score_c, found.score_d, found.grand, found.action_level) == (6, 5, 6, 3)


def test_a_heavy_lift_far_from_the_body_is_7():
    # upper arm 100: 4, abducted 5; elbow 40: 2; wrist 20: 3; end of twist: A (5, 2, 3, 2) 7, + 1 + 3: 11.
    # neck 25: 3; trunk 65: 4; legs 2: B (3, 4, 2) 6, + 4: 10. C (8 and more, 7 and more) 7: immediately
    found = rula(upper_arm_flex=100, upper_arm_abducted=True, elbow_flex=40, wrist_flex=20, wrist_twist=2, neck_flex=25,
                 trunk_flex=65, legs_supported=False, muscle_use=True, force_kg=12, force_pattern="static")  # fmt: skip
    assert (found.table_a, found.table_b, found.score_c, found.score_d) == (7, 6, 11, 10)
    assert (found.grand, found.action_level) == (7, 4)


def test_the_worksheet_of_2000_is_an_option():
    # upper arm 2, lower arm 1, wrist 1, end of twist: 3 published, 2 there; B 1: C (3, 1) 3, (2, 1) 2
    reach = {**NEUTRAL, "upper_arm_flex": 30, "wrist_twist": 2}
    assert (rula(**reach).table_a, rula(**reach).grand) == (3, 3)
    other = rula(**reach, table_a="worksheet2000")
    assert (other.table_a, other.grand) == (2, 2)


def test_more_than_10_kg_now_and_then_is_2_on_paper_and_3_on_the_worksheet():
    # C (1 + 2, 1 + 2) 3; C (1 + 3, 1 + 3) 4
    assert rula(**NEUTRAL, force_kg=12).grand == 3
    assert rula(**NEUTRAL, force_kg=12, force_rule="worksheet").grand == 4


def test_flags_add_one_each_and_support_takes_one_off_but_never_below_1():
    turned = rula(**NEUTRAL, shoulder_raised=1, across_midline_or_out=1, wrist_deviated=1, neck_twisted=1,
                  neck_side_bent=1, trunk_twisted=1, trunk_side_bent=1)  # fmt: skip
    parts = (turned.upper_arm, turned.lower_arm, turned.wrist, turned.neck, turned.trunk)
    assert parts == (2, 2, 2, 3, 3)
    assert rula(**NEUTRAL, arm_supported=True).upper_arm == 1
    assert rula(**{**NEUTRAL, "trunk_flex": 15}, seated_supported=True).trunk == 1


def test_an_edge_belongs_to_the_lower_score():
    assert [upper_arm_score(a) for a in (-91, -90, -21, -20, 20, 21, 45, 46, 90, 91)] == [4, 2, 2, 1, 1, 2, 2, 3, 3, 4]
    assert [wrist_score(a) for a in (-16, -15, -1, 0, 15, 16)] == [3, 2, 2, 1, 2, 3]
    assert [neck_score(a) for a in (-1, 0, 10, 11, 20, 21)] == [4, 1, 1, 2, 2, 3]
    assert [trunk_score(a) for a in (-30, 0, 1, 20, 21, 60, 61)] == [3, 1, 2, 2, 3, 3, 4]


def test_a_tolerance_makes_zero_wider():
    usual = Thresholds()
    assert [trunk_score(a, usual.trunk_upright) for a in (-5, 5, 6)] == [1, 1, 2]
    assert [neck_score(a, usual.neck_extended) for a in (-6, -5, 10)] == [4, 1, 1]
    lax = rula(**{**NEUTRAL, "trunk_flex": 4, "wrist_flex": 2}, thresholds=usual)
    strict = rula(**{**NEUTRAL, "trunk_flex": 4, "wrist_flex": 2})
    assert (lax.trunk, lax.wrist, strict.trunk, strict.wrist) == (1, 1, 2, 2)


def test_all_that_is_wrong_is_said_at_once():
    with pytest.raises(ValueError) as told:
        rula(**{**NEUTRAL, "neck_flex": float("nan"), "trunk_flex": "bent"}, force_kg=-1, table_a="publishd",
             force_pattern="repeatd", wrist_twist=3)  # fmt: skip
    assert str(told.value).splitlines() == [
        "neck_flex: found nan, expected a number",
        "trunk_flex: found 'bent', expected a number",
        "force_kg: found -1, expected 0 or more",
        "table_a: no 'publishd'; did you mean 'published'?",
        "force_pattern: no 'repeatd'; did you mean 'repeated'?",
        "wrist_twist: found 3, expected one of 1, 2",
    ]
