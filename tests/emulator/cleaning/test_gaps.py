from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import CleaningSettings
from emulator.cleaning.gaps import without_gaps
from emulator.cleaning.smoothing import coordinate_noise_m, filtered, highest_hz, residual_analysis, smoothed
from tests.made.takes import clean, error_m, spoilt


def unseen(joint, first, last):
    def change(positions, index):
        positions[first : last + 1, index(joint)] = np.nan

    return spoilt(clean(), change).takes[1]


@pytest.mark.parametrize(("last", "how"), [(39, "bridged by a spline"), (54, "filled from points")])
def test_the_length_of_a_gap_decides_how_it_is_filled(last, how):
    take, repairs = without_gaps(unseen("left_elbow", 30, last), CleaningSettings())
    assert len(repairs) == 1 and how in repairs[0].words
    assert (repairs[0].first_frame, repairs[0].last_frame) == (30, last)
    assert repairs[0].size == pytest.approx((last - 29) / 50)
    assert error_m(take, clean().takes[1]) < 0.03


def test_what_was_seen_is_never_changed():
    take, _ = without_gaps(unseen("left_elbow", 30, 39), CleaningSettings())
    seen = np.ones(take.positions_m.shape[:2], bool)
    seen[30:40, take.names.index("left_elbow")] = False
    assert np.array_equal(take.positions_m[seen], clean().takes[1].positions_m[seen])


def test_a_bridged_bone_keeps_its_length():
    take, _ = without_gaps(unseen("left_wrist", 30, 38), CleaningSettings())
    elbow, wrist = (take.names.index(f"left_{joint}") for joint in ("elbow", "wrist"))
    length = np.linalg.norm(take.positions_m[:, wrist] - take.positions_m[:, elbow], axis=-1)
    assert np.ptp(length) < 1e-6


def test_a_limb_of_which_nothing_is_seen_is_bridged_from_the_trunk_outwards():
    def change(positions, index):
        for joint in ("hand", "wrist", "elbow"):
            positions[30:38, index(f"left_{joint}")] = np.nan

    take, repairs = without_gaps(spoilt(clean(), change).takes[1], CleaningSettings())
    assert [repair.joints[0] for repair in repairs] == ["left_elbow", "left_wrist", "left_hand"]
    assert error_m(take, clean().takes[1]) < 0.01


def test_gaps_at_the_ends_are_trimmed():
    take, repairs = without_gaps(unseen("head", 0, 3), CleaningSettings())
    assert [(r.kind, r.first_frame, r.last_frame, r.joints) for r in repairs] == [("cut", 0, 3, ("head",))]
    assert take.n_frames == clean().takes[1].n_frames - 4


def test_a_mark_that_would_be_cut_off_costs_the_take():
    early = replace(unseen("head", 0, 10), mark_frame={"touch": 4.0})
    late = replace(unseen("head", 0, 10), mark_frame={"touch": 40.0})
    assert without_gaps(early, CleaningSettings())[0] is None
    assert without_gaps(late, CleaningSettings())[0].mark_frame == {"touch": 29.0}


def test_where_gaps_are_to_be_cut_nothing_is_filled():
    take, repairs = without_gaps(replace(unseen("head", 5, 6), mark_frame={}), CleaningSettings(gaps="cut"))
    assert [(r.kind, r.first_frame, r.last_frame) for r in repairs] == [("cut", 0, 6)]
    assert np.isfinite(take.positions_m).all()


def test_without_three_companions_a_long_gap_is_cut():
    def change(positions, index):
        positions[5:25] = np.where(np.arange(positions.shape[1])[:, None] == index("pelvis"), positions[5:25], np.nan)

    take, repairs = without_gaps(
        replace(spoilt(clean(), change).takes[1], mark_frame={}), CleaningSettings(kept_share=0.1)
    )
    assert {repair.kind for repair in repairs} == {"cut"} and np.isfinite(take.positions_m).all()


def test_a_take_without_gaps_is_itself():
    take = clean().takes[0]
    assert without_gaps(take, CleaningSettings()) == (take, ())


def test_frames_lost_within_the_movement_shorten_the_take_and_those_never_seen_do_not():
    def change(positions, index):
        positions[10:30] = np.nan

    take = replace(spoilt(clean(), change).takes[1], mark_frame={})
    _, (cut,) = without_gaps(take, CleaningSettings())
    assert (cut.kind, cut.first_frame, cut.last_frame, cut.shortens) == ("cut", 0, 29, True)
    assert "0.60 s cut off, of which 0.60 s were seen or lie within the movement" in cut.words
    unseen_start = take.positions_m.copy()
    unseen_start[:30] = np.nan
    _, (trimmed,) = without_gaps(replace(take, positions_m=unseen_start), CleaningSettings())
    assert trimmed.last_frame == 29 and not trimmed.shortens and trimmed.words == "not seen; 0.60 s cut off"


def test_a_moment_lost_at_an_end_shortens_nothing():
    assert [cut.shortens for cut in without_gaps(unseen("head", 0, 3), CleaningSettings())[1]] == [False]
    longer = replace(unseen("head", 0, 5), mark_frame={})
    assert [cut.shortens for cut in without_gaps(longer, CleaningSettings())[1]] == [True]


def shaking(sd_m, seed=0):
    take = clean("walk", 1, 1).takes[0]
    noise = sd_m * np.random.default_rng(seed).normal(size=take.positions_m.shape)
    return replace(take, positions_m=take.positions_m + noise)


@pytest.mark.parametrize(("rate_hz", "cut_off_hz"), [(100, 6), (30, 6), (30, 9), (30, 11), (120, 25), (50, 18.5)])
def test_three_decibels_are_lost_at_the_cut_off_after_both_ways(rate_hz, cut_off_hz):
    time_s = np.arange(2000) / rate_hz
    wave = np.sin(2 * np.pi * cut_off_hz * time_s + 0.3)[:, None]
    passed = filtered(wave, rate_hz, cut_off_hz)[500:1500]
    assert np.std(passed) / np.std(wave[500:1500]) == pytest.approx(np.sqrt(0.5), abs=0.002)
    assert np.corrcoef(passed[:, 0], wave[500:1500, 0])[0, 1] > 0.9999  # nothing is shifted in time


def test_residual_analysis_finds_how_much_noise_there_is():
    assert residual_analysis(shaking(0.005).positions_m, 50.0)[1] == pytest.approx(0.005, rel=0.25)


def test_noise_is_measured_joint_by_joint_and_a_smooth_movement_has_none():
    assert coordinate_noise_m(clean("walk", 1, 1).takes[0].positions_m).max() < 1e-4
    assert np.allclose(coordinate_noise_m(shaking(0.003).positions_m), 0.003, rtol=0.35)


def test_noise_is_taken_out_and_the_filtered_take_is_not_filtered_again():
    take = shaking(0.005)
    smooth, repairs = smoothed(take, CleaningSettings())
    truth = clean("walk", 1, 1).takes[0].positions_m
    assert len(repairs) == len(take.names) and "Hz (found by residual analysis)" in repairs[0].words
    assert np.sqrt(np.mean((smooth.positions_m - truth) ** 2)) < 0.0035
    assert smoothed(smooth, CleaningSettings()) == (smooth, ())


def test_an_asked_cut_off_is_taken_and_said_and_never_above_what_the_rate_allows():
    repairs = smoothed(shaking(0.005), CleaningSettings(cut_off_hz=6.0))[1]
    assert "low-pass at 6.0 Hz (as asked)" in repairs[0].words
    assert f"{highest_hz(50.0):.1f} Hz" in smoothed(shaking(0.005), CleaningSettings(cut_off_hz=24.0))[1][0].words


def test_switched_off_or_smooth_nothing_is_filtered():
    take = clean("walk", 1, 1).takes[0]
    assert smoothed(take, CleaningSettings()) == (take, ())
    noisy = shaking(0.005)
    assert smoothed(noisy, CleaningSettings(low_pass="off")) == (noisy, ())
