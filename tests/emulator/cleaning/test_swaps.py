from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import CleaningSettings
from emulator.cleaning.marker_errors import mirrored, without_swaps
from tests.made_takes import clean, error_m, spoilt


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
