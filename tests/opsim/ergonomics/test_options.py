from dataclasses import fields, replace

import pytest

from opsim.ergonomics.options import CHOICES, PAPER, RANGES, USUAL, Options, Thresholds, checked


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
