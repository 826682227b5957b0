from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import CleaningSettings, cleaned
from emulator.cleaning.spikes import largest_beside, surprise_m, surprise_vectors_m, violent_steps, without_jumps
from emulator.skeleton import Skeleton
from tests.made.takes import clean, error_m, spoilt


def away(joint, first, long, by_m):
    def change(positions, index):
        positions[first : first + long, index(joint)] += [0.0, 0.0, by_m]

    return spoilt(clean(), change).takes[1]


def test_a_joint_that_comes_back_is_bridged_and_its_size_is_how_far_it_was_away():
    take, repairs = without_jumps(away("left_wrist", 40, 3, 0.3), CleaningSettings())
    assert [(r.kind, r.joints, r.first_frame, r.last_frame) for r in repairs] == [("glitch", ("left_wrist",), 40, 42)]
    assert repairs[0].size == pytest.approx(0.3, abs=0.01) and error_m(take, clean().takes[1]) < 0.002


def test_a_small_jump_is_no_glitch():
    _, repairs = without_jumps(away("left_wrist", 40, 2, 0.05), CleaningSettings(least_jump_m=0.02))
    assert [repair.kind for repair in repairs] == ["jump"]


def test_what_is_away_for_longer_has_not_jumped():
    take = away("left_wrist", 30, 15, 0.3)
    same, repairs = without_jumps(take, CleaningSettings())
    assert same is take and not repairs
    assert [repair.bad for repair in violent_steps(take, CleaningSettings())] == [True, True]


def test_told_jumps_are_left_and_glitches_make_the_take_bad():
    take = away("left_wrist", 40, 3, 0.3)
    same, repairs = without_jumps(take, CleaningSettings(jumps="tell"))
    assert same is take and repairs[0].bad and not repairs[0].mended and "left as it is" in repairs[0].words


def test_switched_off_nothing_is_looked_for():
    take = away("left_wrist", 40, 3, 0.3)
    off = CleaningSettings(jumps="off")
    assert without_jumps(take, off) == (take, ()) and violent_steps(take, off) == ()


def test_a_bridge_that_would_break_a_bone_is_not_built():
    """The whole hand turns over for a moment, wrist and all: a spline for the wrist alone would stretch the fingers."""

    def change(positions, index):
        elbow, wrist, hand = (index(f"left_{joint}") for joint in ("elbow", "wrist", "hand"))
        bone = positions[40:44, wrist] - positions[40:44, elbow]
        positions[40:44, wrist] -= 2 * bone  # the forearm points the other way, its length is kept
        positions[40:44, hand] += [0.02, 0.0, 0.0]

    take = spoilt(clean(), change).takes[1]
    mended, repairs = without_jumps(take, CleaningSettings())
    fingers = take.names.index("left_hand") - 1
    bones = [Skeleton(t.names, t.parents).bone_lengths(t.positions_m)[:, fingers] for t in (take, mended)]
    assert np.ptp(bones[1]) <= np.ptp(bones[0]) + 1e-9
    assert all(repair.joints == ("left_wrist",) for repair in repairs)


def test_a_short_take_is_left_alone():
    take = clean().takes[0]
    short = replace(take, positions_m=take.positions_m[:8], contact=None, mark_frame={})
    assert without_jumps(short, CleaningSettings()) == (short, ())


@pytest.mark.parametrize(
    ("first", "long", "kept"), [(0, 1, slice(1, None)), (0, 2, slice(2, None)), (-1, 1, slice(-1))]
)
def test_a_jump_at_an_end_is_cut_off(first, long, kept):
    def change(positions, index):
        stop = None if first < 0 else first + long
        positions[first:stop, index("left_wrist")] += [0.0, 0.3, 0.0]

    done = cleaned(spoilt(replace(clean(), takes=tuple(replace(t, mark_frame={}) for t in clean().takes)), change))
    assert np.array_equal(done.recording.takes[1].positions_m, clean().takes[1].positions_m[kept])
    assert {repair.kind for repair in done.repairs if repair.mended} == {"glitch", "cut"}


def way(values):
    return np.array(values, float)[:, None, None] * np.array([1.0, 0.0, 0.0])


def test_an_even_speed_is_no_surprise_and_an_even_acceleration_is_none_but_at_the_ends():
    t = np.arange(10.0)
    assert np.allclose(surprise_m(way(3 * t)), 0) and np.allclose(surprise_m(way(t**2))[1:-1], 0)


def test_a_step_surprises_by_its_size_and_by_half_beside_it():
    found = surprise_vectors_m(way([0, 0, 0, 0, 2, 2, 2, 2]))[:, 0, 0]
    assert np.allclose(found, [0, 0, -1, 2, -1, 0, 0])


def test_a_spike_surprises_by_one_and_a_half_there_and_back():
    found = surprise_vectors_m(way([0, 0, 0, 0, 2, 0, 0, 0, 0]))[:, 0, 0]
    assert np.allclose(found, [0, 0, -1, 3, -3, 1, 0, 0])


def test_beside_what_was_not_seen_nothing_surprises():
    values = way([0, 0, 0, np.nan, 5, 5, 5, 5])
    assert np.all(surprise_m(values) == 0)


def test_the_largest_beside_looks_at_both_neighbours():
    assert largest_beside(np.array([1.0, 3.0, 2.0])).tolist() == [3.0, 2.0, 3.0]
