from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import CleaningSettings, cleaned
from emulator.cleaning.settings import mistakes, size_m
from tests.made_takes import clean


def changed(change):
    made = clean()
    return replace(made, takes=tuple(replace(take, positions_m=change(take.positions_m)) for take in made.takes))


@pytest.mark.parametrize(
    ("times", "unit"), [(1000.0, "millimetres"), (100.0, "centimetres"), (39.37, "inches"), (10.0, "decimetres")]
)
def test_a_body_in_another_unit_is_refused_with_the_unit_it_would_be(times, unit):
    with pytest.raises(ValueError) as said:
        cleaned(changed(lambda positions: times * positions))
    first = str(said.value).splitlines()[0]
    assert first.startswith("take w1/r1: found ") and "expected 0.6 to 2.6 m" in first and f"in {unit}" in first


def test_all_takes_are_named_but_not_more_than_a_few():
    assert mistakes(changed(lambda p: 1000 * p), CleaningSettings())[-1] == "and 3 more takes of 8"


@pytest.mark.parametrize(("axes", "said"), [([0, 2, 1], "along y"), ([2, 1, 0], "along x")])
def test_a_body_that_stands_along_another_axis_is_refused(axes, said):
    found = mistakes(changed(lambda p: p[..., axes]), CleaningSettings())
    assert len(found) == 1 and said in found[0] and "expected z up" in found[0]


def test_a_body_on_its_head_is_refused():
    assert "on their heads" in mistakes(changed(lambda p: p * [1, -1, -1]), CleaningSettings())[0]


def test_a_joint_that_is_never_seen_is_named():
    def unseen(positions):
        positions = positions.copy()
        positions[:, clean().names.index("left_hand")] = np.nan
        return positions

    assert mistakes(changed(unseen), CleaningSettings()) == [
        "left_hand: found in no frame, expected joints that are seen, or none of this name"
    ]


def test_a_take_in_which_nothing_is_seen_is_refused():
    assert "found no frame" in mistakes(changed(lambda p: np.full_like(p, np.nan)), CleaningSettings())[0]


def test_switched_off_anything_passes():
    assert mistakes(changed(lambda p: 10 * p), CleaningSettings(plausible="off")) == []


def test_the_size_of_a_body_is_that_between_its_farthest_joints():
    assert 1.4 < size_m(clean().takes[0]) < 2.0
