"""RULA by hand: every table looked up in the paper's print, the arithmetic beside it.

REBA by hand: every table looked up in the paper's print, the arithmetic beside it.

OWAS by hand, from the print of the table of action categories.

The published tables: they rise, but for OWAS where it is known not to.
"""

import numpy as np
import pytest

from opsim.ergonomics.options import Thresholds
from opsim.ergonomics.scores.owas import owas, owas_code
from opsim.ergonomics.scores.reba import knee_score, reba, reba_neck_score, reba_trunk_score, reba_wrist_score
from opsim.ergonomics.scores.rula import neck_score, rula, trunk_score, upper_arm_score, wrist_score
from opsim.ergonomics.scores.tables import (
    OWAS,
    OWAS_ALTERNATIVES,
    REBA_A,
    REBA_B,
    REBA_C,
    RULA_A,
    RULA_B,
    RULA_C,
    owas_level,
    owas_load,
    owas_table,
    reba_level,
    reba_load,
    rula_force,
    rula_level,
)
from tests.opsim.ergonomics.reference import reference

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


REBA_NEUTRAL = {"neck_flex": 5, "trunk_flex": 0, "upper_arm_flex": 0, "elbow_flex": 80, "wrist_flex": 0}


def test_everything_neutral_is_1_of_reba():
    found = reba(**REBA_NEUTRAL)
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
    assert (
        reba(**REBA_NEUTRAL, trunk_twisted=1, trunk_side_bent=1).trunk
        == reba(**REBA_NEUTRAL, trunk_twisted=1).trunk
        == 2
    )
    assert (
        reba(**REBA_NEUTRAL, neck_twisted=1, neck_side_bent=1).neck == reba(**REBA_NEUTRAL, neck_side_bent=1).neck == 2
    )


def test_the_knees_of_a_sitter_do_not_count():
    assert (
        reba(**REBA_NEUTRAL, knee_flex=90).legs == 3
        and reba(**REBA_NEUTRAL, knee_flex=90, sitting=True, bilateral=0).legs == 1
    )


def test_edges_are_as_in_the_paper():
    assert [knee_score(a) for a in (29, 30, 60, 61)] == [0, 1, 1, 2]
    assert [reba_neck_score(a) for a in (-1, 0, 20, 21)] == [2, 1, 1, 2]
    assert [reba_trunk_score(a) for a in (-61, -21, -20, 0, 1, 20, 21, 60, 61)] == [3, 3, 2, 1, 2, 2, 3, 3, 4]
    assert [reba_wrist_score(a) for a in (-16, -15, 0, 15, 16)] == [2, 1, 1, 1, 2]


def test_all_that_is_wrong_is_said_at_once_of_reba():
    with pytest.raises(ValueError) as told:
        reba(**{**REBA_NEUTRAL, "elbow_flex": None}, load_kg=float("inf"), coupling=4, activity=-1)
    assert str(told.value).splitlines() == [
        "elbow_flex: found nothing, expected a number",
        "load_kg: found inf, expected a number",
        "coupling: found 4, expected one of 0, 1, 2, 3",
        "activity: found -1, expected one of 0, 1, 2, 3",
    ]


@pytest.mark.parametrize(
    ("code", "category"),
    [
        ("1121", 1),
        ("1373", 2),
        ("2121", 2),
        ("2141", 3),
        ("2152", 3),
        ("3151", 4),
        ("3161", 1),
        ("4151", 4),
        ("4371", 2),
    ],
)
def test_categories_are_as_printed(code, category):
    assert owas(code).category == category and owas(code).code == code


def test_the_disputed_categories_are_options():
    assert [owas("3373").category, owas("3373", ("3373",)).category] == [1, 2]
    assert [owas("4132").category, owas("4132", ("3373",)).category, owas("4132", ("4132",)).category] == [2, 2, 3]


@pytest.mark.parametrize(
    ("posture", "code"),
    [
        ({"trunk_flex": 19.9}, "1121"),
        ({"trunk_flex": 20}, "2121"),
        ({"trunk_flex": -25}, "2121"),
        ({"trunk_flex": 0, "trunk_side": -20}, "3121"),
        ({"trunk_flex": 45, "trunk_twist": 25, "arms_up": 1}, "4221"),
        ({"trunk_flex": 0, "left_knee": 31, "right_knee": 31, "load_kg": 10}, "1141"),
        ({"trunk_flex": 0, "left_knee": 31, "right_knee": 30, "load_kg": 10.5}, "1122"),
        ({"trunk_flex": 0, "left_knee": 31, "one_legged": True, "load_kg": 20}, "1132"),
        ({"trunk_flex": 0, "left_knee": 90, "right_knee": 90, "one_legged": True, "load_kg": 21}, "1153"),
        ({"trunk_flex": 0, "left_knee": 90, "right_knee": 90, "sitting": True}, "1111"),
        ({"trunk_flex": 0, "left_knee": 60, "walking": True, "arms_up": 2}, "1371"),
    ],
)
def test_angles_become_digits(posture, code):
    assert owas_code(**posture) == code


def test_thresholds_are_options():
    assert owas_code(trunk_flex=16, thresholds=Thresholds(owas_back=15)) == "2121"


def test_wrong_codes_are_told():
    with pytest.raises(ValueError, match=r"no '3374'; did you mean '3373'\?\ncode 5120: back is 5, expected 1 to 4\n"
                       r"code 5120: load is 0, expected 1 to 3"):  # fmt: skip
        owas("5120", ("3374",))
    with pytest.raises(ValueError, match="code: found '21a1', expected four digits: back, arms, legs, load"):
        owas("21a1")
    with pytest.raises(ValueError, match="arms_up: found 3, expected one of 0, 1, 2"):
        owas_code(trunk_flex=0, arms_up=3)


@pytest.mark.parametrize(
    ("load_kg", "scores"),
    [(0, (0, 0, 0, 3)), (1.9, (0, 0, 0, 3)), (2, (1, 2, 2, 3)), (10, (1, 2, 2, 3)), (10.1, (2, 3, 3, 3))],
)
def test_rulas_force_is_as_in_the_papers_figure(load_kg, scores):
    patterns = ("intermittent", "repeated", "static", "shock")
    assert tuple(rula_force(load_kg, pattern) for pattern in patterns) == scores


def test_the_worksheet_counts_more_than_10_kg_as_3():
    assert [rula_force(kg, "intermittent", "worksheet") for kg in (10, 10.1)] == [1, 3]


def test_rebas_load_begins_at_5_kg_and_owas_after_10():
    assert [reba_load(kg) for kg in (4.9, 5, 10, 10.1)] == [0, 1, 1, 2] and reba_load(12, shock=True) == 3
    assert [owas_load(kg) for kg in (0, 10, 10.1, 20, 20.1)] == [1, 1, 2, 2, 3]


def test_unknown_words_are_refused_with_the_nearest():
    with pytest.raises(ValueError, match="no force 'statik'; did you mean 'static'"):
        rula_force(5, "statik")
    with pytest.raises(ValueError, match="no rule of force 'sheet'"):
        rula_force(5, "static", "sheet")


def test_every_score_has_the_level_of_its_paper():
    assert [rula_level(score).number for score in range(1, 8)] == [1, 1, 2, 2, 3, 3, 4]
    assert [reba_level(score).number for score in range(1, 16)] == [0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 4, 4, 4, 4, 4]
    assert [owas_level(score).number for score in range(1, 5)] == [1, 2, 3, 4]


def test_levels_have_the_published_words():
    assert rula_level(7).text == "investigation and changes required immediately"
    assert reba_level(8).text.startswith("high risk") and owas_level(4).text == "extremely harmful, action immediately"


@pytest.mark.parametrize(("level", "score", "most"), [(rula_level, 0, 7), (reba_level, 16, 15), (owas_level, 2.5, 4)])
def test_what_is_no_score_is_refused(level, score, most):
    with pytest.raises(ValueError, match=f"no score {score}, expected 1 to {most}"):
        level(score)


RISING = {
    **{f"RULA A {name}": table for name, table in RULA_A.items()},
    "RULA B": RULA_B,
    "RULA C": RULA_C,
    "REBA A": REBA_A,
    "REBA B": REBA_B,
    "REBA C": REBA_C,
}


@pytest.mark.parametrize("name", RISING)
def test_the_tables_of_rula_and_reba_rise_with_every_code(name):
    for axis in range(RISING[name].ndim):
        assert np.all(np.diff(RISING[name], axis=axis) >= 0), axis


@pytest.mark.parametrize("disputed", [(), *((code,) for code in OWAS_ALTERNATIVES)])
def test_owas_rises_with_arms_and_load(disputed):
    table = owas_table(disputed)
    assert np.all(np.diff(table, axis=1) >= 0) and np.all(np.diff(table, axis=3) >= 0)


def falls(axis):
    """{digit: in how many cells OWAS falls from it to the next}, of back (0) or legs (2)."""
    digits, cells = np.unique(np.argwhere(np.diff(OWAS, axis=axis) < 0)[:, axis] + 1, return_counts=True)
    return dict(zip(digits.tolist(), cells.tolist()))


def test_owas_falls_from_a_bent_back_to_a_twisted_one_and_with_the_legs_and_nowhere_else():
    assert falls(0) == {2: 35}  # 2111 is 2, 3111 is 1
    assert falls(2) == {1: 13, 5: 19, 6: 15}  # 2311 is 3, 2321 is 2; 1151 is 2, 1161 is 1; 2363 is 4, 2371 is 2


def test_the_worksheet_of_2000_is_lower_in_31_cells():
    less = RULA_A["published"] - RULA_A["worksheet2000"]
    assert [int((less == points).sum()) for points in (-1, 0, 1, 2)] == [0, 113, 30, 1]


def test_disputed_categories_are_the_other_ones_where_asked():
    assert OWAS[2, 2, 6, 2] == 1 and owas_table(("3373",))[2, 2, 6, 2] == 2
    assert OWAS[3, 0, 2, 1] == 2 and owas_table(("4132",))[3, 0, 2, 1] == 3
    assert (owas_table(("3373", "4132")) != OWAS).sum() == 2


def test_tables_cannot_be_written_to():
    for table in (*RISING.values(), OWAS):
        with pytest.raises(ValueError, match="read-only"):
            table[(0,) * table.ndim] = 9


def test_no_cell_is_mistyped():
    known = reference("ergonomic_tables.json")
    for ours, theirs in (
        (RULA_A["published"], known["rula"]["table_a"]),
        (RULA_A["worksheet2000"], known["rula"]["table_a_variant_2000_worksheet"]["values"]),
        (RULA_B, known["rula"]["table_b"]),
        (RULA_C, known["rula"]["table_c"]),
        (REBA_A, known["reba"]["table_a"]),
        (REBA_B, known["reba"]["table_b"]),
        (REBA_C, known["reba"]["table_c"]),
        (OWAS, known["owas"]["table"]),
    ):
        assert np.array_equal(ours, theirs)
    assert {cell["code"]: cell["alternative"] for cell in known["owas"]["disputed_cells"]} == OWAS_ALTERNATIVES
