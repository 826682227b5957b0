"""Laws of cleaning as a whole.

Cleaning on public recordings: the known glitches are found, clean movements are left.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.cleaning import CleaningSettings, Repair, cleaned, verdict_of
from emulator.cleaning.report import impossible, told
from emulator.motion import turn
from emulator.recordings.npz import read_recording
from emulator.recordings.take import Recording
from emulator.synthetic.choreography import TASKS
from tests.made.takes import clean, error_m, same, spoilt
from tests.recordings import recording

EVERYTHING = CleaningSettings(bones="mend", offsets="mend", angles="mend")
QUIET = {"hold", "heading"}


def few():
    """Four takes, cleaned in half the time of the usual eight."""
    return clean("reach", 2, 2)


@pytest.mark.parametrize("task", sorted(TASKS))
def test_a_clean_made_recording_goes_through_unchanged(task):
    done = cleaned(clean(task, 2, 3))
    assert same(done.recording, clean(task, 2, 3))
    assert not [repair for repair in done.repairs if repair.mended or repair.bad]
    assert {done.verdict(name) for name in done.names} == {"good"}


def spike(positions, index):
    positions[40:43, index("right_wrist")] += [0.0, 0.25, 0.2]


def gap(positions, index):
    positions[30:36, index("left_elbow")] = np.nan


def swap(positions, index):
    pair = [index("left_wrist"), index("right_wrist")]
    positions[30:50, pair] = positions[30:50, pair[::-1]]


def slip(positions, index):
    shoulder, elbow = index("right_shoulder"), index("right_elbow")
    positions[50:, elbow] += 0.3 * (positions[50:, shoulder] - positions[50:, elbow])


FAULTS = {"spike": spike, "gap": gap, "swap": swap, "slip": slip}
ERROR_M = {"spike": 0.002, "gap": 0.005, "swap": 1e-12, "slip": 0.03}
KINDS = {"spike": "glitch", "gap": "gap", "swap": "swap", "slip": "slip"}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found_at_its_place_and_mended(fault):
    before = few()
    done = cleaned(spoilt(before, FAULTS[fault]))
    found = [repair for repair in done.repairs if repair.kind not in {*QUIET, "bone"}]
    assert [repair.kind for repair in found] == [KINDS[fault]] and found[0].mended
    assert found[0].take == before.takes[1].name
    assert error_m(done.recording.takes[1], before.takes[1]) < ERROR_M[fault]
    assert same(replace(done.recording, takes=done.recording.takes[:1]), replace(before, takes=before.takes[:1]))
    assert done.verdict(before.takes[1].name) == "repaired" and done.verdict(before.takes[0].name) == "good"


@pytest.mark.parametrize("fault", FAULTS)
def test_cleaning_twice_is_cleaning_once(fault):
    once = cleaned(spoilt(few(), FAULTS[fault])).recording
    twice = cleaned(once)
    assert same(once, twice.recording) and not [repair for repair in twice.repairs if repair.mended]


@pytest.mark.parametrize("fault", FAULTS)
def test_turning_and_shifting_the_world_turns_and_shifts_what_is_cleaned(fault):
    def moved(recording):
        takes = [replace(t, positions_m=turn(t.positions_m, 1.1) + np.array([2.0, -3.0, 0.0])) for t in recording.takes]
        return replace(recording, takes=tuple(takes))

    spoiled = spoilt(few(), FAULTS[fault])
    here, there = cleaned(spoiled), cleaned(moved(spoiled))
    assert [(r.take, r.kind, r.joints, r.first_frame, r.last_frame) for r in here.repairs] == [
        (r.take, r.kind, r.joints, r.first_frame, r.last_frame) for r in there.repairs
    ]
    for one, other in zip(moved(here.recording).takes, there.recording.takes):
        assert error_m(one, other) < 1e-9


def test_what_takes_are_called_and_in_which_order_they_come_changes_nothing():
    spoiled = spoilt(few(), spike)
    renamed = replace(spoiled, takes=tuple(replace(t, trial=f"x{t.trial}") for t in spoiled.takes[::-1]))
    one, other = cleaned(spoiled), cleaned(renamed)
    assert same(one.recording, replace(other.recording, takes=other.recording.takes[::-1]))
    assert len(one.repairs) == len(other.repairs)


@settings(max_examples=12, deadline=None)
@given(
    joint=st.sampled_from(["left_wrist", "right_elbow", "head", "left_knee", "right_toe", "pelvis"]),
    first=st.integers(6, 60),
    long=st.integers(1, 8),
    away=st.floats(0.1, 0.8),
    angle=st.floats(0, 6.28),
)
def test_a_jump_anywhere_of_any_length_up_to_a_sixth_of_a_second_is_mended(joint, first, long, away, angle):
    def jump(positions, index):
        positions[first : first + long, index(joint)] += away * np.array([np.cos(angle), np.sin(angle), 0.3])

    before = few()
    done = cleaned(spoilt(before, jump), CleaningSettings(holds="off"))
    found = [repair for repair in done.repairs if repair.mended]
    assert [(r.joints, r.first_frame, r.last_frame) for r in found] == [((joint,), first, first + long - 1)]
    assert error_m(done.recording.takes[1], before.takes[1]) < 0.01


@settings(max_examples=12, deadline=None)
@given(
    joint=st.sampled_from(["left_wrist", "right_elbow", "head", "left_knee", "right_hip", "pelvis"]),
    first=st.integers(1, 50),
    long=st.integers(1, 25),
)
def test_a_gap_of_up_to_half_a_second_is_filled(joint, first, long):
    def unseen(positions, index):
        positions[first : first + long, index(joint)] = np.nan

    before = few()
    done = cleaned(spoilt(before, unseen))
    assert np.isfinite(done.recording.takes[1].positions_m).all()
    if done.recording.takes[1].n_frames == before.takes[1].n_frames:
        assert error_m(done.recording.takes[1], before.takes[1]) < 0.03
        assert [(r.kind, r.joints) for r in done.repairs if r.mended] == [("gap", (joint,))]


def test_noise_is_taken_out_and_clean_joints_are_left():
    def shaking(positions, index):
        positions[:, index("left_wrist")] += 0.004 * np.random.default_rng(1).normal(size=(len(positions), 3))

    before = clean("reach", 2, 4)
    done = cleaned(spoilt(before, shaking))
    noise = [repair for repair in done.repairs if repair.kind == "noise"]
    assert [repair.joints for repair in noise] == [("left_wrist",)] and "residual analysis" in noise[0].words
    wrist = before.names.index("left_wrist")
    off = done.recording.takes[1].positions_m - before.takes[1].positions_m
    assert np.sqrt(np.mean(off[5:-5, wrist] ** 2)) < 0.0025
    assert np.all(np.delete(off, wrist, axis=1) == 0)
    assert same(done.recording, cleaned(done.recording).recording)


def test_marks_and_contact_go_along_when_the_start_is_cut_off():
    def unseen(positions, index):
        positions[:5, index("head")] = np.nan

    before = few()
    done = cleaned(spoilt(before, unseen))
    take = done.recording.takes[1]
    assert take.n_frames == before.takes[1].n_frames - 5 == len(take.contact)
    assert all(take.mark_frame[name] == before.takes[1].mark_frame[name] - 5 for name in take.mark_frame)
    assert done.first_frame(take.name) == 5
    assert np.array_equal(take.positions_m, before.takes[1].positions_m[5:])


def test_frames_of_what_is_found_after_a_cut_are_those_of_the_take_that_was_read():
    def both(positions, index):
        positions[:10, index("head")] = np.nan
        slip(positions, index)

    done = cleaned(spoilt(few(), both))
    assert next(r for r in done.repairs if r.kind == "slip").first_frame == 50


def test_a_take_of_which_too_little_is_seen_is_left_out_and_said():
    def unseen(positions, index):
        positions[20:, index("head")] = np.nan

    before = few()
    done = cleaned(spoilt(before, unseen))
    assert [name for name, _ in done.left_out] == [before.takes[1].name]
    assert len(done.recording.takes) == len(before.takes) - 1
    assert done.verdict(before.takes[1].name) == "left out"
    assert [name for name, _, _ in done.pairs()] == [name for name in done.names if name != before.takes[1].name]
    assert any("left out" in note for note in done.recording.notes)


def test_where_no_take_can_be_used_all_are_named():
    nothing = tuple(replace(t, positions_m=np.where(np.arange(t.n_frames)[:, None, None] > 10, np.nan, t.positions_m))
                    for t in few().takes)  # fmt: skip
    with pytest.raises(ValueError, match="no take can be used") as said:
        cleaned(Recording(nothing))
    assert all(take.name in str(said.value) for take in nothing)


def test_takes_of_one_name_are_told_apart():
    twice = replace(few(), takes=(few().takes[0], few().takes[0]))
    done = cleaned(spoilt(twice, spike))
    assert done.names == ("w1/r1", "w1/r1 (2)")
    assert [done.verdict(name) for name in done.names] == ["good", "repaired"]


def test_nothing_is_written_into_what_was_given():
    spoiled = spoilt(few(), spike)
    copies = [take.positions_m.copy() for take in spoiled.takes]
    cleaned(spoiled)
    assert all(np.array_equal(take.positions_m, copy) for take, copy in zip(spoiled.takes, copies))


def test_progress_is_told_take_by_take():
    seen = []
    cleaned(few(), progress=lambda *said: seen.append(said))
    n = len(few().takes)
    assert seen[0] == (1, n, "jumps and gaps") and seen[-1] == (n, n, "angles and noise")


def test_markers_without_bones_are_cleaned_too():
    bare = replace(few(), takes=tuple(replace(take, parents=None) for take in few().takes))
    done = cleaned(spoilt(bare, spike))
    assert [repair.kind for repair in done.repairs] == ["glitch"]
    assert error_m(done.recording.takes[1], bare.takes[1]) < 0.002


@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n_frames=st.integers(2, 90), bare=st.booleans())
def test_whatever_is_missing_or_thrown_about_the_rest_is_whole_or_refused_in_words(seed, n_frames, bare):
    rng = np.random.default_rng(seed)
    takes = []
    for take in few().takes[:3]:
        positions = take.positions_m[:n_frames].copy()
        seen = rng.random(positions.shape) > rng.choice([0.0, 0.01, 0.3])
        positions = np.where(seen, positions, rng.choice([np.nan, np.inf]))
        positions[rng.integers(len(positions)), rng.integers(21)] += rng.normal(size=3) * rng.choice([0, 0.1, 1.0])
        parents = None if bare else take.parents
        takes.append(replace(take, positions_m=positions, parents=parents, mark_frame={}, contact=None))
    try:
        done = cleaned(Recording(tuple(takes)), EVERYTHING)
    except ValueError as refused:
        assert "take" in str(refused) or "found in no frame" in str(refused)
        return
    assert all(np.isfinite(take.positions_m).all() for take in done.recording.takes)
    assert len(done.recording.takes) + len(done.left_out) == 3
    for repair in done.repairs:
        assert 0 <= repair.first_frame <= repair.last_frame < n_frames and np.isfinite(repair.size)


def test_mending_everything_leaves_a_clean_made_recording_to_a_tenth_of_a_millimetre():
    done = cleaned(clean("lift"), EVERYTHING)
    assert max(error_m(one, other) for one, other in zip(done.recording.takes, clean("lift").takes)) < 1e-4


def test_with_bones_held_cleaning_twice_is_still_cleaning_once():
    once = cleaned(spoilt(few(), slip), EVERYTHING).recording
    assert same(once, cleaned(once, EVERYTHING).recording)


def test_the_glitched_squats_are_found_and_at_most_two_others():
    done = cleaned(read_recording(recording("hdm05_squat_once")))
    glitched = {repair.take for repair in done.repairs if repair.kind == "glitch"}
    known = {"dg/026", "dg/027", "dg/028", "dg/030"}
    assert glitched >= known and len(glitched - known) <= 2
    assert {name for name in done.names if done.verdict(name) == "bad"} >= known


@pytest.mark.parametrize(
    "name",
    [
        *(pytest.param(f"uiprmd_{name}", marks=pytest.mark.slow) for name in ("deep_squat", "leg_raise")),
        *("hdm05_jog_circle", "hdm05_sneak_2steps"),
    ],
)
def test_recordings_without_faults_go_through_to_the_bit(name):
    before = read_recording(recording(name))
    done = cleaned(before)
    assert same(before, done.recording) and not any(repair.mended or repair.bad for repair in done.repairs)


def test_a_spike_in_a_real_squat_is_mended_to_a_few_millimetres():
    whole = read_recording(recording("uiprmd_deep_squat"))
    before = replace(whole, takes=whole.takes[:8])
    take = before.takes[3]
    wrist = take.names.index("left_wrist")
    spoiled = take.positions_m.copy()
    spoiled[60:64, wrist] += [0.1, 0.2, -0.1]
    changed = replace(before, takes=(*before.takes[:3], replace(take, positions_m=spoiled), *before.takes[4:]))
    done = cleaned(changed)
    assert [(r.kind, r.joints, r.first_frame, r.last_frame) for r in done.repairs if r.mended] == [
        ("glitch", ("left_wrist",), 60, 63)
    ]
    assert np.linalg.norm(done.recording.takes[3].positions_m - take.positions_m, axis=-1).max() < 0.003


def test_a_full_turn_is_told_as_one():
    take = clean("walk", 1, 1).takes[0]
    yaw = np.linspace(0, 2 * np.pi, take.n_frames)[:, None]
    found = told(replace(take, positions_m=turn(take.positions_m, yaw)), CleaningSettings())
    heading = [repair for repair in found if repair.kind == "heading"]
    assert len(heading) == 1 and heading[0].size == pytest.approx(360, abs=15) and not heading[0].mended


def test_a_pause_is_told_where_it_is():
    take = clean("reach", 1, 1).takes[0]
    held = np.concatenate(
        [take.positions_m[:40], np.repeat(take.positions_m[40:41], 50, axis=0), take.positions_m[40:]]
    )
    found = told(replace(take, positions_m=held, contact=None), CleaningSettings(heading="off"))
    assert [repair.kind for repair in found] == ["hold"]
    assert abs(found[0].first_frame - 40) <= 4 and abs(found[0].last_frame - 90) <= 4
    assert told(replace(take, positions_m=held, contact=None), CleaningSettings(holds="off", heading="off")) == ()


def test_points_without_hips_have_no_heading_and_no_pauses():
    take = clean("reach", 1, 1).takes[0]
    assert told(replace(take, parents=None), CleaningSettings()) == ()


def test_what_is_still_faster_than_any_body_is_bad():
    take = clean("reach", 1, 1).takes[0]
    assert impossible(take) == ()
    flying = take.positions_m + np.arange(take.n_frames)[:, None, None] * [0.5, 0.0, 0.0]
    found = impossible(replace(take, positions_m=flying))
    assert found[0].bad and "at most 13" in found[0].words


def test_a_body_that_does_not_move_is_told_of_and_not_called_good():
    take = clean("reach", 1, 1).takes[0]
    shaking_m = np.random.default_rng(0).normal(0, 5e-4, (90, *take.positions_m.shape[1:]))
    frozen = np.repeat(take.positions_m[:1], 90, axis=0) + shaking_m
    found = told(replace(take, positions_m=frozen, contact=None), CleaningSettings())
    assert [repair.kind for repair in found] == ["still"] and verdict_of(found) == "told"
    sliding = frozen + np.linspace(0, 1, 90)[:, None, None] * [1.0, 0.0, 0.0]
    assert told(replace(take, positions_m=sliding, contact=None), CleaningSettings()) == ()


def test_what_was_mended_does_not_hide_what_was_left():
    jump = Repair("w/1", "jump", ("head",), 3, 4, 0.1, "m", "jumps; bridged")
    over = Repair("w/1", "angle", ("left_ankle",), 3, 9, 46.0, "deg", "46 deg over; left as it is", False)
    cut = Repair("w/1", "cut", ("head",), 0, 29, 0.6, "s", "not seen; 0.60 s cut off", shortens=True)
    assert verdict_of([jump]) == "repaired" and verdict_of([jump, over]) == "repaired, told"
    assert verdict_of([jump, cut]) == "shortened" and verdict_of([jump, cut, over]) == "shortened, told"


def test_a_bone_that_breathes_much_is_told_of_and_one_that_breathes_a_little_is_not():
    bone = Repair("w/1", "bone", ("left_knee",), 0, 99, 6.7, "%", "breathes; left as it is", False)
    assert verdict_of([bone]) == "told" and verdict_of([replace(bone, size=1.3)]) == "good"
