"""Joint angles, their limits, and offsets against a person's other takes."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import CleaningSettings
from emulator.cleaning.bones_and_angles import (
    angle_deg,
    beyond,
    median_lengths_m,
    neutral_angles,
    turned,
    with_even_bones,
    within_limits,
)
from emulator.cleaning.marker_errors import without_offsets
from emulator.cleaning.settings import LIMITS, limits_for
from emulator.skeleton import Skeleton
from tests.made.takes import clean, error_m, spoilt


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


def limit(joint, what):
    return next(each for each in limits_for(clean().names) if (each.joint, each.what) == (joint, what))


def bent(take, joint, far, what, by_deg):
    """The take with what hangs on ``far`` turned about ``joint`` so that the angle grows by by_deg."""
    _, axis = angle_deg(take, limit(joint, what))
    axis = np.where(np.isfinite(axis), axis, [0.0, 1.0, 0.0])
    return replace(take, positions_m=turned(take, joint, far, axis, np.full(take.n_frames, float(by_deg))))


def test_every_limit_has_a_source_and_is_found_on_both_sides():
    assert all(each.source and each.low_deg < each.high_deg for each in LIMITS)
    assert {each.joint for each in limits_for(clean().names)} >= {"left_knee", "right_knee", "neck", "left_ankle"}
    assert limits_for(("pelvis", "head")) == []


def test_turning_a_joint_changes_its_angle_by_so_much_and_keeps_every_bone():
    take = clean().takes[0]
    more = bent(take, "left_elbow", "left_wrist", "flexion", 25.0)
    elbow = limit("left_elbow", "flexion")
    assert np.allclose(angle_deg(more, elbow)[0] - angle_deg(take, elbow)[0], 25.0)
    assert np.allclose(median_lengths_m(take), median_lengths_m(more), equal_nan=True)


def test_what_hangs_on_a_joint_is_found():
    take = clean().takes[0]
    assert {take.names[j] for j in beyond(take, "left_knee")} == {"left_knee", "left_ankle", "left_toe"}


def test_a_clean_take_is_within_all_limits():
    for task in ("reach", "lift", "walk"):
        take = clean(task, 1, 1).takes[0]
        assert within_limits(take, CleaningSettings(), neutral_angles([take])) == (take, ())


def test_a_knee_bent_the_wrong_way_is_hyperextended_and_one_bent_the_right_way_is_not():
    take = clean("walk", 1, 1).takes[0]
    over = limit("left_knee", "hyperextension")
    bend = angle_deg(take, limit("left_knee", "flexion"))[0]
    assert np.nanmax(angle_deg(take, over)[0]) < 5
    wrong = bent(take, "left_knee", "left_ankle", "flexion", -(bend.max() + 35))
    assert np.nanmax(angle_deg(wrong, over)[0]) > 30
    found = within_limits(wrong, CleaningSettings(), {})[1]
    assert ("left_knee", "hyperextension") in {(repair.joints[0], repair.words.split()[0]) for repair in found}


@pytest.mark.parametrize(
    ("joint", "far", "what"), [("left_elbow", "left_wrist", "flexion"), ("left_knee", "left_ankle", "flexion")]
)
def test_an_angle_beyond_its_limit_is_told_and_asked_for_is_turned_back_to_what_is_believed(joint, far, what):
    take = clean().takes[0]
    usual, bend = neutral_angles([take]), angle_deg(take, limit(joint, what))[0]
    wrong = bent(take, joint, far, what, 178 - bend.max())
    same, repairs = within_limits(wrong, CleaningSettings(), usual)
    assert same is wrong and [(r.joints, r.mended) for r in repairs] == [((joint,), False)]
    assert repairs[0].size == pytest.approx(178 - limit(joint, what).high_deg, abs=0.5)
    mended, _ = within_limits(wrong, CleaningSettings(angles="mend"), usual)
    believed = limit(joint, what).high_deg + CleaningSettings().tolerance_deg
    assert angle_deg(mended, limit(joint, what))[0].max() == pytest.approx(believed, abs=1e-6)
    assert within_limits(mended, CleaningSettings(angles="mend"), usual) == (mended, ())


def test_a_constant_offset_against_the_other_takes_is_found_and_asked_for_taken_out():
    takes = list(clean("walk", 1, 6).takes)
    before = takes[2]
    takes[2] = bent(before, "right_elbow", "right_wrist", "flexion", 30.0)
    found = without_offsets(takes, CleaningSettings())
    assert [len(repairs) for _, repairs in found] == [0, 0, 1, 0, 0, 0]
    repair = found[2][1][0]
    assert repair.joints == ("right_elbow",) and repair.size == pytest.approx(30, abs=6) and not repair.mended
    mended = without_offsets(takes, CleaningSettings(offsets="mend"))[2][0]
    assert error_m(mended, before) < 0.25 * error_m(takes[2], before)
    after = [mended if take is takes[2] else take for take in takes]
    assert not any(repairs for _, repairs in without_offsets(after, CleaningSettings()))


def test_an_offset_that_several_takes_share_is_a_way_of_moving():
    takes = list(clean("walk", 1, 6).takes)
    for number in (1, 2):
        takes[number] = bent(takes[number], "right_elbow", "right_wrist", "flexion", 30.0)
    assert not any(repairs for _, repairs in without_offsets(takes, CleaningSettings()))


def test_of_few_takes_no_offset_is_told():
    takes = list(clean("walk", 1, 3).takes)
    takes[2] = bent(takes[2], "right_elbow", "right_wrist", "flexion", 30.0)
    assert not any(repairs for _, repairs in without_offsets(takes, CleaningSettings()))
