"""A take cut: laws, and what cannot be cut.

Cut times as text: written, read again, mistakes with file and line.

Synthesis: cycles repeated, units joined at common postures, a take cut and joined again.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.composite.joining import joined
from emulator.recordings.take import Recording, Take
from emulator.segmenting.repetitions import postures, speed_per_s
from emulator.segmenting.segment import (
    Cut,
    NothingFound,
    cut_recording,
    cut_times_text,
    parse_cut_times,
    piece,
    segment,
    was_edited,
)
from emulator.segmenting.synthesis import common_postures, joined_at_common_posture, motion_of, repeated, take_of
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


def a_take(name="ana", n=1000, rate_hz=50.0):
    return Take(("pelvis", "neck"), (-1, 0), np.zeros((n, 2, 3)), rate_hz, name, "long")


TAKES = (a_take(), a_take("ben", 700))
NAMES = st.text("abc123.-_äß", min_size=1, max_size=6)


@st.composite
def cuts_of(draw, n_frames):
    frames = sorted(draw(st.sets(st.integers(0, n_frames - 1), max_size=12)))
    pairs = list(zip(frames[::2], frames[1::2], strict=False))
    names = draw(st.lists(NAMES, min_size=len(pairs), max_size=len(pairs), unique=True))
    return tuple(Cut(start, stop, name) for (start, stop), name in zip(pairs, names, strict=True))


@given(cuts_of(1000), cuts_of(700), st.sampled_from([24.0, 29.97, 50.0, 120.0, 1000.0, 0.5]))
def test_what_is_written_is_read_again(first, second, rate_hz):
    takes = (a_take(rate_hz=rate_hz), a_take("ben", 700, rate_hz))
    cuts = {"ana/long": first, "ben/long": second}
    text = cut_times_text(takes, cuts)
    assert not was_edited(text)
    if first or second:
        assert parse_cut_times(text, takes, "x.txt") == cuts


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_with_its_name(text):
    try:
        found = parse_cut_times(text, TAKES, "x.txt")
    except ValueError as error:
        assert all(line.startswith("x.txt") for line in str(error).split("\n"))
    else:
        assert found


def test_a_line_that_was_changed_is_seen():
    text = cut_times_text(TAKES[:1], {"ana/long": (Cut(50, 100, "1"),)})
    assert was_edited(text.replace("1.000", "1.020")) and was_edited(text + "9 10 z\n") and was_edited("")
    assert "1.000 2.000 1" in text


def test_one_take_needs_no_name_and_comments_and_blank_lines_are_passed_over():
    text = "# by hand\n\n 1.0  2.0 up   # the first\r\n2.0 2.5 down\n"
    assert parse_cut_times(text, TAKES[:1], "x") == {"ana/long": (Cut(50, 100, "up"), Cut(100, 125, "down"))}


def test_a_take_whose_name_holds_brackets_and_a_hash_is_found():
    takes = (a_take("a#1"), a_take("[b]"))
    cuts = {take.name: (Cut(5, 9, "1"),) for take in takes}
    assert parse_cut_times(cut_times_text(takes, cuts), takes, "x") == cuts


def test_the_end_of_the_take_is_within():
    assert parse_cut_times("0 19.98 all", TAKES[:1], "x")["ana/long"] == (Cut(0, 999, "all"),)


def test_every_mistake_is_said_at_once_with_file_and_line():
    text = "\n".join(
        [
            "1 2 early",
            "[ana/lng]",
            "1 2 passed over",
            "[ana/long]",
            "1.0 2.0",
            "1.0 two 1",
            "3.0 2.0 2",
            "1.0 99 3",
            "4.0 5.0 4",
            "4.5 6.0 5",
            "7.0 8.0 4",
            "nan inf 6",
            "8.0 9.0 a/b",
            "[ana/long]",
        ]
    )
    with pytest.raises(ValueError) as caught:
        parse_cut_times(text, TAKES, "cuts.txt")
    said = str(caught.value).split("\n")
    expected = [
        "cuts.txt:1: found a time before any [worker/trial]",
        "cuts.txt:2: no take 'ana/lng'; did you mean 'ana/long'?",
        "cuts.txt:5: found 2 words, expected three",
        "cuts.txt:6: found 'two', expected seconds",
        "cuts.txt:7: found the end 2.0 s",
        "cuts.txt:8: found 99 s, expected 0 to 19.980 s",
        "cuts.txt:10: found the start 4.500 s, expected 5.000 s or later, where 4 ends",
        "cuts.txt:11: found the name '4' again, first in line 9",
        "cuts.txt:12: found 'nan', expected seconds",
        "cuts.txt:12: found 'inf', expected seconds",
        "cuts.txt:13: found the name 'a/b'",
        "cuts.txt:14: found a second [ana/long]",
    ]
    assert len(said) == len(expected)
    for line, start in zip(said, expected, strict=True):
        assert line.startswith(start), line


def test_a_file_without_times_is_refused():
    with pytest.raises(ValueError, match=r"cuts.txt: found no cut times, expected lines such as"):
        parse_cut_times("# nothing\n[ana/long]\n", TAKES, "cuts.txt")


def test_a_name_is_told_as_a_second_one_even_where_its_times_are_wrong():
    with pytest.raises(ValueError) as caught:
        parse_cut_times("[ana/long]\n1 two a\n3 4 a\n", TAKES, "cuts.txt")
    said = str(caught.value).split("\n")
    assert [line[:11] for line in said] == ["cuts.txt:2:", "cuts.txt:3:"]
    assert "found the name 'a' again, first in line 2" in said[1]


@pytest.fixture(scope="module")
def whole_walk():
    return walking(5.5, 40.0, rate_hz=50.0)


def motions_of(take):
    return [motion_of(take, cut.start, cut.stop) for cut in segment(take, "cycles").cuts]


def steps(motion):
    """How far the bones turn from frame to frame, (T - 1,)."""
    return np.linalg.norm(np.diff(motion.directions, axis=0), axis=(1, 2))


def test_a_take_cut_into_cycles_and_joined_again_is_the_take(whole_walk):
    cuts = segment(whole_walk, "cycles").cuts
    again = joined(motions_of(whole_walk))
    part = motion_of(whole_walk, cuts[0].start, cuts[-1].stop)
    assert again.duration_s == pytest.approx(part.duration_s, abs=1e-12)
    assert np.abs(again.directions - part.directions).max() < 1e-9
    assert np.abs(again.root_m - part.root_m).max() < 1e-9


def test_a_cycle_repeated_lasts_so_many_times_as_long_and_never_jumps(whole_walk):
    cycle = motions_of(whole_walk)[0]
    again = repeated(cycle, 5)
    assert again.duration_s == pytest.approx(5 * cycle.duration_s, abs=1e-9)
    assert steps(again).max() < 1.5 * steps(cycle).max()


def test_a_cycle_repeated_is_cut_into_equal_cycles_again(whole_walk):
    cycle = motions_of(whole_walk)[0]
    again = segment(take_of(repeated(cycle, 6), 50.0), "cycles").cuts
    length = np.array([cut.stop - cut.start for cut in again])
    assert len(again) in (5, 6) and np.abs(length - 50 * cycle.duration_s).max() <= 1


def test_units_are_joined_where_they_are_most_alike_and_speed_stays_continuous():
    whole_walk = swinging(*phases(24, 8, 4, 40, 12, 12), rate_hz=50.0)
    start, end = motion_of(whole_walk, 0, 110), motion_of(whole_walk, 70, whole_walk.n_frames - 1)
    leave, enter, gap = common_postures(start, end)
    assert gap <= 0.05 and abs((leave - enter - 70 + 20) % 40 - 20) <= 2 and leave > 100 and enter < 50
    whole = joined_at_common_posture([start, end])
    assert steps(whole).max() < 1.3 * max(steps(start).max(), steps(end).max())
    assert whole.duration_s == pytest.approx((leave + len(end.time_s) - 1 - enter) / 50.0, abs=1e-9)


def test_units_without_a_common_posture_are_refused(whole_walk):
    bent = motion_of(whole_walk)
    other = motion_of(take_of(bent, 50.0), 0, 30)
    away = np.roll(other.directions, 1, axis=2)
    with pytest.raises(ValueError, match=r"have no posture in common: the nearest two are \d+ degrees apart"):
        joined_at_common_posture([bent, replace(other, directions=away)])


def test_a_take_as_a_motion_and_back_is_the_take(whole_walk):
    back = take_of(motion_of(whole_walk), whole_walk.rate_hz)
    assert np.abs(back.positions_m - whole_walk.positions_m).max() < 1e-9


@pytest.mark.parametrize(("start", "stop"), [(5, 5), (-1, 5), (0, 9999)])
def test_frames_that_a_take_has_not_are_refused(whole_walk, start, stop):
    with pytest.raises(ValueError, match="take w1/1: found frames"):
        motion_of(whole_walk, start, stop)


def test_no_times_is_refused(whole_walk):
    with pytest.raises(ValueError, match="found 0 times, expected 1 or more"):
        repeated(motion_of(whole_walk), 0)
