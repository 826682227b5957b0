"""Periods, cycles, units and denoising: waves of known truth.

The judge of cycle boundaries against foot contact can fail.
"""

from itertools import pairwise

import numpy as np
import pytest

from emulator.segmenting.cycles import (
    NAMES,
    cycles,
    cyclic_coordinate,
    denoised,
    fitted_curve,
    period_frames,
    units,
    unlikeness,
)
from tests.take_evidence.cycles_judged import judged, strikes


def wave(n_cycles=6.3, period=30.0):
    return np.sin(2 * np.pi * np.arange(round(n_cycles * period)) / period)


def test_a_sine_is_cut_where_it_passes_0_and_all_its_cycles_are_equal():
    found = cycles(wave(), 30.0)
    assert np.allclose(found.boundary % 15, 0, atol=0.05) or np.allclose((found.boundary + 7) % 15, 7, atol=0.05)
    inner = slice(1, -1)
    assert np.allclose((found.stop - found.start)[inner], 30, atol=0.05)
    assert np.array_equal(found.stop[:-1], found.start[1:])


def test_peaks_and_valleys_come_in_turn_and_a_wave_on_the_way_is_none():
    at = np.arange(300)
    found = cycles(np.sin(2 * np.pi * at / 50) + 0.15 * np.sin(2 * np.pi * at / 9), 50.0)
    assert np.all(np.diff(found.rising.astype(int)) != 0)
    assert len(found.extremes) in range(11, 15)


def test_backwards_the_boundaries_are_mirrored():
    y = wave(6.3, 31.7) + 0.3 * wave(12.6, 15.85)[: round(6.3 * 31.7)]
    there, back = cycles(y, 31.7), cycles(y[::-1], 31.7)
    assert np.allclose(there.boundary, len(y) - 1 - back.boundary[::-1], atol=1e-9)


def test_larger_and_shifted_the_boundaries_are_the_same():
    y = wave()
    assert np.allclose(cycles(y, 30.0).boundary, cycles(-7 * y + 3, 30.0).boundary, atol=1e-9)


def test_what_stands_still_has_no_cycles_and_no_units():
    found = cycles(np.zeros(100), 20.0)
    assert len(found.start) == 0
    with pytest.raises(ValueError, match="no cycle found"):
        units(found)


@pytest.mark.parametrize("period", [12.0, 31.4, 77.0])
def test_the_period_of_waves_with_noise_is_found(period):
    at = 2 * np.pi * np.arange(round(5.5 * period))[:, None] / period
    points = np.concatenate([np.cos(at), np.sin(at), 0.5 * np.sin(2 * at)], axis=1)
    points = points + 0.05 * np.random.default_rng(0).normal(size=points.shape)
    assert abs(period_frames(points) - period) < 1.0


def test_the_period_of_a_step_left_and_a_step_right_is_both_steps():
    at = 2 * np.pi * np.arange(200)[:, None] / 40
    assert period_frames(np.concatenate([np.sin(at), 0.4 * np.cos(2 * at)], axis=1)) == 40


def test_what_never_comes_back_has_no_period():
    assert period_frames(np.arange(100.0)[:, None]) is None


def test_unlikeness_is_0_at_once_and_about_1_for_noise():
    unlike = unlikeness(np.random.default_rng(0).normal(size=(2000, 5)))
    assert unlike[0] < 1e-12 and np.allclose(unlike[1:], 1, atol=0.1)


def test_the_cyclic_coordinate_is_the_wave_and_not_the_drift():
    at = np.arange(300)
    y = cyclic_coordinate(np.stack([at / 300 - 0.5, 0.1 * np.sin(2 * np.pi * at / 30)], axis=1), 30.0)
    assert abs(np.corrcoef(y, np.sin(2 * np.pi * at / 30))[0, 1]) > 0.99


def seeds_walk(period=19):
    """The coordinate of the paper's walk: 24 frames still, 7 to start, three cycles of 19, 10 to stop, 10 still."""
    still = np.zeros(24), np.zeros(10)
    start = np.sin(np.linspace(-0.5, 0, 8)[:-1] * np.pi) * np.linspace(0, 1, 7)
    cyclic = np.sin(2 * np.pi * np.arange(3 * period) / period)
    stop = np.sin(np.linspace(0, 1, 10) * np.pi) * np.linspace(1, 0, 10)
    return np.concatenate([still[0], start, cyclic, stop, still[1]])


def test_the_five_units_of_the_seeds_walk():
    """24 | 7 | 57 | 10 | 10 frames: each edge within 3 frames."""
    found = units(cycles(seeds_walk(), 19.0))
    assert tuple(unit.name for unit in found) == NAMES
    edges = [unit.stop for unit in found[:-1]]
    assert np.abs(np.array(edges) - np.cumsum([24, 7, 57, 10])).max() <= 3


def test_units_tile_the_take():
    for y, period in ((seeds_walk(), 19.0), (wave(), 30.0), (wave(2.2), 30.0)):
        found = units(cycles(y, period))
        assert found[0].start == 0 and found[-1].stop == len(y)
        assert all(a.stop == b.start for a, b in pairwise(found))


def test_without_rest_there_is_nothing_prepared_and_nothing_wound_up():
    found = {unit.name: unit.n_frames for unit in units(cycles(wave(), 30.0))}
    assert found["preparing"] <= 4 and found["wind-up"] <= 4


def test_the_fitted_curve_is_the_wave():
    assert np.abs(fitted_curve(wave(), 30.0) - wave()).max() < 0.01


def test_only_points_further_than_the_threshold_are_moved_and_none_past_the_curve():
    y, rng = wave(), np.random.default_rng(0)
    noisy = y + 0.02 * rng.normal(size=len(y))
    noisy[[20, 77, 120]] += (0.5, -0.4, 0.3)
    pulled, which = denoised(noisy, y, 0.1)
    assert set(np.flatnonzero(which)) == {20, 77, 120}
    assert np.array_equal(pulled[~which], noisy[~which])
    assert np.all(np.abs(pulled - y)[which] < np.abs(noisy - y)[which])
    assert np.all(np.sign(pulled - y)[which] * np.sign(noisy - y)[which] >= 0)


def test_a_curve_on_its_fit_stays_as_it_is():
    assert np.array_equal(denoised(wave(), wave())[0], wave())


def contact(strides, n=None):
    """(T, 2) of a walk whose left foot strikes at the running sum of ``strides`` and bears for half of each."""
    at = np.cumsum([7, *strides])
    bears = np.zeros((n or at[-1] + 10, 2), bool)
    for start, stride in zip(at, [*strides, strides[-1]], strict=True):
        bears[start : start + stride // 2, 0] = True
    return bears, at


def test_boundaries_at_one_phase_are_all_right_whatever_the_phase():
    bears, at = contact([30, 33, 27, 30, 31])
    for offset in (-13, 0, 5, 14):
        inside = at + offset
        found = judged(inside[inside >= 0].astype(float), bears)
        assert found.right == found.judged == len(inside[inside >= 0]) - 1
        assert found.offset % 30 in (offset % 30, offset % 30 - 30)


def test_one_boundary_five_frames_off_spoils_both_cycles_beside_it():
    bears, at = contact([30, 30, 30, 30, 30])
    boundary = at.astype(float)
    boundary[2] += 5
    assert judged(boundary, bears).right == 3


def test_a_boundary_that_is_missing_spoils_its_cycle():
    bears, at = contact([30, 30, 30, 30, 30])
    found = judged(np.delete(at, 2).astype(float), bears)
    assert (found.right, found.judged) == (3, 4)
    assert (found.strides_found, found.strides) == (3, 5)


def test_boundaries_at_random_are_mostly_wrong():
    bears, at = contact([30] * 40)
    rng = np.random.default_rng(0)
    found = judged(np.sort(rng.uniform(0, at[-1], 41)), bears)
    assert found.right < 0.2 * found.judged


def test_flickers_are_no_strikes():
    bears, at = contact([30, 30, 30])
    bears[at[1] + 5, 0] = False
    bears[at[2] - 6, 0] = True
    assert np.array_equal(strikes(bears[:, 0])[1:3], at[1:3])
