import numpy as np

from emulator.cleaning import CleaningSettings
from emulator.cleaning.bones_and_angles import median_lengths_m
from emulator.cleaning.marker_errors import without_slips
from tests.made_takes import clean, error_m, spoilt


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
