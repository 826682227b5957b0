import numpy as np
import pytest

from emulator.cleaning import CleaningSettings
from emulator.cleaning.bones_and_angles import median_lengths_m, with_even_bones
from emulator.skeleton import Skeleton
from tests.made_takes import clean, spoilt


def breathing(share=0.1):
    """The left forearm longer and shorter by ``share``, the hand going along."""

    def change(positions, index):
        elbow, wrist, hand = (index(f"left_{joint}") for joint in ("elbow", "wrist", "hand"))
        by = share * np.sin(np.arange(len(positions)) / 5)[:, None] * (positions[:, wrist] - positions[:, elbow])
        positions[:, wrist] += by
        positions[:, hand] += by

    return spoilt(clean(), change).takes[1]


def lengths(take):
    return Skeleton(take.names, take.parents).bone_lengths(take.positions_m)


def test_a_bone_that_breathes_is_told_with_its_spread_and_left():
    take = breathing()
    same, repairs = with_even_bones(take, CleaningSettings())
    assert same is take and [repair.joints for repair in repairs] == [("left_wrist",)]
    assert repairs[0].size == pytest.approx(100 * 0.1 / np.sqrt(2), abs=0.5) and not repairs[0].bad


def test_asked_for_bones_are_held_at_their_median_along_their_directions():
    take = breathing()
    held, repairs = with_even_bones(take, CleaningSettings(bones="mend"))
    assert np.ptp(lengths(held), axis=0).max() < 1e-12
    assert np.allclose(lengths(held)[0], np.median(lengths(take), axis=0))
    skeleton = Skeleton(take.names, take.parents)
    assert np.allclose(skeleton.directions(held.positions_m), skeleton.directions(take.positions_m))
    assert [repair.mended for repair in repairs] == [True]
    again, none = with_even_bones(held, CleaningSettings(bones="mend"))
    assert again is held and none == ()


def test_a_bone_that_changes_by_more_than_a_bone_can_makes_the_take_bad():
    _, repairs = with_even_bones(breathing(0.7), CleaningSettings())
    assert [repair.bad for repair in repairs] == [True] and "is no bone" in repairs[0].words


def test_median_lengths_are_those_of_the_bones_and_nan_at_the_root():
    take = clean().takes[0]
    found = median_lengths_m(take)
    assert np.isnan(found[take.names.index("pelvis")])
    assert np.allclose(np.delete(found, take.names.index("pelvis")), np.median(lengths(take), axis=0))
