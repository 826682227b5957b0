from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import CleaningSettings
from emulator.cleaning.smoothing import coordinate_noise_m, filtered, highest_hz, residual_analysis, smoothed
from tests.made_takes import clean


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
