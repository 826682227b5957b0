"""A take cut: laws, and what cannot be cut."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.recordings.take import Recording
from emulator.segmenting.repetitions import postures, speed_per_s
from emulator.segmenting.segment import Cut, NothingFound, cut_recording, piece, segment
from tests.emulator.segmenting.made_movements import backwards, moved, phases, swinging, walking
from tests.emulator.segmenting.test_repetitions import made_take


@pytest.fixture(scope="module")
def walk():
    return walking()


def edges(take, kind="auto"):
    return np.array([(cut.start, cut.stop) for cut in segment(take, kind).cuts])


def test_swinging_without_rests_is_cut_into_its_cycles_all_equal(walk):
    found = segment(walk)
    assert found.kind == "cycles" and len(found.cuts) in (5, 6)
    assert np.abs(np.diff(edges(walk), axis=1) - 31.3).max() <= 1
    assert [cut.name for cut in found.cuts] == [str(i + 1) for i in range(len(found.cuts))]


def test_the_walk_of_the_seed_has_five_units_and_three_cycles():
    """24 | 7 | 57 | 10 | 10 frames of 108: all edges within 5."""
    found = segment(swinging(*phases()), "cycles")
    assert len(found.cuts) == 3
    stops = [unit.stop for unit in found.units[:-1]]
    assert np.abs(np.array(stops) - np.cumsum([24, 7, 57, 10])).max() <= 5


def test_turned_shifted_and_larger_the_cuts_are_the_same(walk):
    assert np.array_equal(edges(walk), edges(moved(walk, yaw_rad=2.0, by_m=(3.0, -1.0, 0.2), scale=1.3)))


def test_backwards_the_cuts_are_mirrored(walk):
    last = walk.n_frames - 1
    assert np.abs(edges(walk) - (last - edges(backwards(walk))[::-1, ::-1])).max() <= 1


def test_rests_between_decide_between_repetitions_and_cycles():
    take, truth = made_take("reach", 5, seed=2)
    assert segment(take).kind == "repetitions" and len(segment(take).cuts) == len(truth)


def test_continuous_repetitions_are_found_when_asked_for():
    take, _ = made_take("reach", 6, seed=5, hold_s=None)
    assert len(segment(take, "repetitions").cuts) == 6


def test_slow_movements_are_thinned_out_and_all_frames_have_coordinates():
    take = walking(4.6, 210.0, rate_hz=200.0)
    found = segment(take, "cycles")
    assert found.curve.stride > 3 and len(found.curve.coordinates) == take.n_frames
    assert np.abs(np.diff(edges(take, "cycles"), axis=1) - 210).max() <= 8


def test_pieces_keep_the_worker_number_the_trial_and_shift_marks_and_contact(walk):
    contact = np.arange(2 * walk.n_frames).reshape(-1, 2) % 3 == 0
    take = replace(walk, mark_frame={"grasp": 50.5}, contact=contact)
    one = piece(take, Cut(40, 60, "2"))
    assert one.name == "w1/1.2" and one.mark_frame == {"grasp": 10.5}
    assert np.array_equal(one.positions_m, take.positions_m[40:61])
    assert np.array_equal(one.contact, contact[40:61])


def test_a_mark_that_some_pieces_lack_is_left_out_and_said(walk):
    take = replace(walk, mark_frame={"grasp": 50.0})
    cut = cut_recording(Recording((take,)), [segment(take)], "cut from walk.npz")
    assert all(not one.mark_frame for one in cut.takes)
    assert any("the mark grasp was left out" in note for note in cut.notes)


def test_pieces_one_after_the_other_are_the_take(walk):
    found = segment(walk)
    pieces = [piece(walk, cut).positions_m for cut in found.cuts]
    whole = np.concatenate([pieces[0], *(one[1:] for one in pieces[1:])])
    assert np.array_equal(whole, walk.positions_m[found.cuts[0].start : found.cuts[-1].stop + 1])


def test_speed_is_that_of_the_movement_and_noise_counts_little():
    at = np.arange(400)[:, None] / 50.0
    points = np.hstack([2.0 * at, np.zeros((400, 5))])
    noisy = points + 0.01 * np.random.default_rng(0).normal(size=points.shape)
    assert np.allclose(speed_per_s(points, 50.0), 2.0)
    assert np.abs(speed_per_s(noisy, 50.0).mean() - 2.0) < 0.02
    still = speed_per_s(0.01 * np.random.default_rng(1).normal(size=(400, 6)), 50.0)
    assert still.mean() < 0.15


def _with_gap(take):
    positions = take.positions_m.copy()
    positions[17, 4] = np.nan
    return replace(take, positions_m=positions)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda take: replace(take, positions_m=take.positions_m[:1]), "found 1 frame, expected 8 or more"),
        (lambda take: replace(take, positions_m=take.positions_m[:1].repeat(90, axis=0)), "the body does not move"),
        (_with_gap, r"found 1 gaps \(the first at frame 17, .*\), expected none: clean it first"),
        (lambda take: replace(take, parents=None), "found markers, expected joints"),
    ],
)
def test_what_cannot_be_cut_is_said_with_the_take(walk, spoil, said):
    with pytest.raises(ValueError, match=f"take w1/1: {said}"):
        segment(spoil(walk))


def test_where_there_is_no_cycle_that_is_said():
    with pytest.raises(NothingFound, match="no cycles found"):
        segment(walking(0.7, 120.0), "cycles")


def test_more_neighbours_than_frames_are_refused(walk):
    with pytest.raises(ValueError, match=r"take w1/1: found k = 900 neighbours, expected 4 to"):
        segment(walk, "cycles", k=900)


def test_an_unknown_kind_is_refused(walk):
    with pytest.raises(ValueError, match="found 'steps', expected auto, repetitions, cycles"):
        segment(walk, "steps")


def test_takes_of_a_few_frames_and_of_noise_are_cut_or_refused_in_words():
    rng = np.random.default_rng(0)
    take = walking(2.0, 20.0)
    for n in (8, 9, 12, 20, 40):
        for scale in (0.0, 0.01, 0.3):
            noisy = take.positions_m[:n] + scale * rng.standard_normal((n, *take.positions_m.shape[1:]))
            for kind in ("auto", "repetitions", "cycles"):
                try:
                    cuts = segment(replace(take, positions_m=noisy), kind).cuts
                except ValueError as error:
                    assert "take w1/1" in str(error)
                else:
                    assert all(0 <= cut.start < cut.stop < n for cut in cuts)


def test_posture_points_have_unit_bones(walk):
    points = postures(walk).reshape(walk.n_frames, -1, 3)
    assert np.allclose(np.linalg.norm(points, axis=2), 1)
