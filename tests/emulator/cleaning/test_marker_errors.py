from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import CleaningSettings
from emulator.cleaning.bones_and_angles import median_lengths_m
from emulator.cleaning.marker_errors import mirrored, without_slips, without_swaps
from tests.made.takes import clean, error_m, spoilt


def slipped(first, last, share=0.3):
    def change(positions, index):
        shoulder, elbow = index("right_shoulder"), index("right_elbow")
        inside = slice(first, last + 1)
        positions[inside, elbow] += share * (positions[inside, shoulder] - positions[inside, elbow])

    return spoilt(clean(), change).takes[1]


def usual():
    return median_lengths_m(clean().takes[0])


def test_the_side_on_which_bones_are_as_in_other_takes_is_right_even_if_it_is_shorter():
    take, repairs = without_slips(slipped(0, 70), CleaningSettings(), usual())
    assert [(r.kind, r.first_frame, r.last_frame) for r in repairs] == [("slip", 0, 70)]
    assert error_m(take, clean().takes[1]) < 0.04


def test_of_one_take_the_longer_stretch_is_right():
    _, repairs = without_slips(slipped(60, 200), CleaningSettings(), None)
    assert [(r.first_frame, r.joints) for r in repairs] == [(60, ("right_elbow",))]


def test_a_stretch_in_the_middle_is_put_back():
    take, repairs = without_slips(slipped(30, 55), CleaningSettings(), usual())
    assert [(r.first_frame, r.last_frame) for r in repairs] == [(30, 55)]
    assert error_m(take, clean().takes[1]) < 0.03


def test_a_bone_that_turns_and_stays_as_long_has_not_slipped():
    def change(positions, index):
        elbow, wrist = index("right_elbow"), index("right_wrist")
        bone = positions[50:, wrist] - positions[50:, elbow]
        positions[50:, wrist] = positions[50:, elbow] - bone
        positions[50:, index("right_hand")] -= 2 * bone

    take = spoilt(clean(), change).takes[1]
    same, repairs = without_slips(take, CleaningSettings(), usual())
    assert same is take and not repairs


def test_told_slips_are_left():
    take = slipped(60, 200)
    same, repairs = without_slips(take, CleaningSettings(slips="tell"), usual())
    assert same is take and repairs[0].bad and repairs[0].size > 0.05


def test_a_clean_take_is_itself():
    take = clean().takes[1]
    assert without_slips(take, CleaningSettings(), np.array(usual())) == (take, ())


def exchanged(first, last, joint="wrist"):
    def change(positions, index):
        pair = [index(f"left_{joint}"), index(f"right_{joint}")]
        positions[first : last + 1, pair] = positions[first : last + 1, pair[::-1]]

    return spoilt(clean(), change).takes[1]


@pytest.mark.parametrize("joint", ["wrist", "ankle", "shoulder"])
@pytest.mark.parametrize(("first", "last"), [(20, 20), (20, 40), (0, 30), (60, 93), (10, 80)])
def test_exchanged_joints_are_put_back_wherever_it_was(joint, first, last):
    last = min(last, clean().takes[1].n_frames - 1)
    take, repairs = without_swaps(exchanged(first, last, joint), CleaningSettings())
    assert [(r.first_frame, r.last_frame) for r in repairs] == [(first, last)]
    assert repairs[0].joints == (f"left_{joint}", f"right_{joint}")
    assert error_m(take, clean().takes[1]) == 0.0


def test_without_bones_the_shorter_stretch_is_the_swapped_one():
    take, repairs = without_swaps(replace(exchanged(20, 40), parents=None), CleaningSettings())
    assert [(r.first_frame, r.last_frame) for r in repairs] == [(20, 40)]
    assert error_m(take, clean().takes[1]) == 0.0


def test_a_swap_while_not_seen_is_found_after_the_gap():
    take = exchanged(25, 45)
    positions = take.positions_m.copy()
    positions[23:25, [take.names.index("left_wrist"), take.names.index("right_wrist")]] = np.nan
    mended, repairs = without_swaps(replace(take, positions_m=positions), CleaningSettings())
    assert [(r.first_frame, r.last_frame) for r in repairs] == [(25, 45)]
    seen = np.isfinite(mended.positions_m)
    assert np.array_equal(mended.positions_m[seen], clean().takes[1].positions_m[seen])


def test_told_swaps_are_left_and_the_take_is_bad():
    take = exchanged(20, 40)
    same, repairs = without_swaps(take, CleaningSettings(swaps="tell"))
    assert same is take and repairs[0].bad


def test_joints_are_mirrored_by_their_names():
    assert mirrored(("head", "right_knee", "left_knee", "left_hand")) == [(2, 1)]
