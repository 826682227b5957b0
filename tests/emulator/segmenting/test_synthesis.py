"""Synthesis: cycles repeated, units joined at common postures, a take cut and joined again."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.composite.joining import joined
from emulator.segmenting.segment import segment
from emulator.segmenting.synthesis import (
    common_postures,
    joined_at_common_posture,
    motion_of,
    repeated,
    take_of,
)
from tests.emulator.segmenting.made_movements import phases, swinging, walking


@pytest.fixture(scope="module")
def walk():
    return walking(5.5, 40.0, rate_hz=50.0)


def motions_of(take):
    return [motion_of(take, cut.start, cut.stop) for cut in segment(take, "cycles").cuts]


def steps(motion):
    """How far the bones turn from frame to frame, (T - 1,)."""
    return np.linalg.norm(np.diff(motion.directions, axis=0), axis=(1, 2))


def test_a_take_cut_into_cycles_and_joined_again_is_the_take(walk):
    cuts = segment(walk, "cycles").cuts
    again = joined(motions_of(walk))
    part = motion_of(walk, cuts[0].start, cuts[-1].stop)
    assert again.duration_s == pytest.approx(part.duration_s, abs=1e-12)
    assert np.abs(again.directions - part.directions).max() < 1e-9
    assert np.abs(again.root_m - part.root_m).max() < 1e-9


def test_a_cycle_repeated_lasts_so_many_times_as_long_and_never_jumps(walk):
    cycle = motions_of(walk)[0]
    again = repeated(cycle, 5)
    assert again.duration_s == pytest.approx(5 * cycle.duration_s, abs=1e-9)
    assert steps(again).max() < 1.5 * steps(cycle).max()


def test_a_cycle_repeated_is_cut_into_equal_cycles_again(walk):
    cycle = motions_of(walk)[0]
    again = segment(take_of(repeated(cycle, 6), 50.0), "cycles").cuts
    length = np.array([cut.stop - cut.start for cut in again])
    assert len(again) in (5, 6) and np.abs(length - 50 * cycle.duration_s).max() <= 1


def test_units_are_joined_where_they_are_most_alike_and_speed_stays_continuous():
    walk = swinging(*phases(24, 8, 4, 40, 12, 12), rate_hz=50.0)
    start, end = motion_of(walk, 0, 110), motion_of(walk, 70, walk.n_frames - 1)
    leave, enter, gap = common_postures(start, end)
    assert gap <= 0.05 and abs((leave - enter - 70 + 20) % 40 - 20) <= 2 and leave > 100 and enter < 50
    whole = joined_at_common_posture([start, end])
    assert steps(whole).max() < 1.3 * max(steps(start).max(), steps(end).max())
    assert whole.duration_s == pytest.approx((leave + len(end.time_s) - 1 - enter) / 50.0, abs=1e-9)


def test_units_without_a_common_posture_are_refused(walk):
    bent = motion_of(walk)
    other = motion_of(take_of(bent, 50.0), 0, 30)
    away = np.roll(other.directions, 1, axis=2)
    with pytest.raises(ValueError, match=r"have no posture in common: the nearest two are \d+ degrees apart"):
        joined_at_common_posture([bent, replace(other, directions=away)])


def test_a_take_as_a_motion_and_back_is_the_take(walk):
    back = take_of(motion_of(walk), walk.rate_hz)
    assert np.abs(back.positions_m - walk.positions_m).max() < 1e-9


@pytest.mark.parametrize(("start", "stop"), [(5, 5), (-1, 5), (0, 9999)])
def test_frames_that_a_take_has_not_are_refused(walk, start, stop):
    with pytest.raises(ValueError, match="take w1/1: found frames"):
        motion_of(walk, start, stop)


def test_no_times_is_refused(walk):
    with pytest.raises(ValueError, match="found 0 times, expected 1 or more"):
        repeated(motion_of(walk), 0)
