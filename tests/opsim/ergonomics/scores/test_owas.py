"""OWAS by hand, from the print of the table of action categories."""

import pytest

from opsim.ergonomics.options import Thresholds
from opsim.ergonomics.scores.owas import owas, owas_code


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
