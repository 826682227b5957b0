import re
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from emulator.fitting.registration import clock_size
from emulator.geometry import base_points as alignable
from emulator.geometry import sphere
from emulator.geometry import warps as warp
from emulator.geometry.alignment import align, align_to, resample
from emulator.geometry.base_points import ROOM_RAD, Labels, base_points, checked, mean_posture
from emulator.geometry.elastic import tsrvf
from emulator.motion import turn
from emulator.recordings import read_motions
from emulator.synthetic.choreography import TASKS
from emulator.synthetic.tasks import make
from tests.made import made_sequences
from tests.recordings import recording

CLOCK = np.linspace(0, 1, 101)


@pytest.fixture(scope="module")
def made():
    sequences, warps, _ = made_sequences(20, 101, seed=2)
    return sequences, warps, align(list(sequences))


def test_the_warps_put_in_are_found_within_one_cell(made):
    _, warps, alignment = made
    truth = warp.centre(warp.invert(warps))
    error_cells = np.abs(alignment.warps - truth) * 100
    assert np.abs(truth - CLOCK).mean() * 100 > 4
    assert error_cells.mean() <= 0.5 and error_cells.max() < 5


@pytest.mark.parametrize(
    "task", [t if t in ("reach", "fasten") else pytest.param(t, marks=pytest.mark.slow) for t in TASKS]
)
def test_the_warps_of_made_work_are_found_within_one_cell(task):
    motions, truth = make(task, 5, 6, seed=1)
    alignment = align([motion.directions for motion in motions.motions])
    error_cells = np.abs(warp.evaluate(alignment.warps, np.linspace(0, 1, 201)) - warp.centre(truth.warps)) * 100
    assert np.abs(warp.centre(truth.warps) - np.linspace(0, 1, 201)).mean() * 100 > 1.5
    assert error_cells.mean() <= 1.0


def test_pure_warps_of_one_sequence_leave_nothing_but_noise():
    sequences, _, _ = made_sequences(12, 301, seed=4, variation=0.0)
    alignment = align(list(sequences), n_times=301)
    assert alignment.explained > 0.985
    apart = sphere.angle(alignment.directions, sphere.mean(alignment.directions))
    assert np.degrees(apart).mean() < 0.5


def test_the_warps_take_most_of_the_variance_away(made):
    *_, alignment = made
    assert alignment.explained == pytest.approx(1 - min(alignment.history) / alignment.before)
    assert alignment.explained > 0.75


@pytest.mark.parametrize("seed", [2, *(pytest.param(k, marks=pytest.mark.slow) for k in (5, 6))])
def test_the_objective_never_rises_and_the_last_round_is_the_best(seed):
    sequences, _, _ = made_sequences(20, 61, seed=seed)
    alignment = align(list(sequences), n_times=61, tolerance=-1.0, max_iterations=8)
    assert len(alignment.history) == 8 and alignment.history[0] > alignment.history[3]
    assert all(later <= earlier * (1 + 1e-12) for earlier, later in pairwise(alignment.history))
    fields = tsrvf(alignment.directions, alignment.reference)
    centred = np.mean(np.sum((fields - fields.mean(0)) ** 2, axis=(1, 2))) / 60
    assert centred < 1.05 * alignment.history[-1]


SIX = ("sit_to_stand", "deep_squat", "side_lunge", "inline_lunge", "shoulder_abduction", "shoulder_scaption")


@pytest.mark.parametrize("name", [*SIX[:2], *(pytest.param(name, marks=pytest.mark.slow) for name in SIX[2:])])
def test_on_recordings_the_objective_never_rises_and_settles_and_centring_costs_at_most_1_5_percent(name):
    motions = read_motions(recording(f"uiprmd_{name}"), where="cov_correct==1")
    alignment = align([motion.directions for motion in motions.motions])
    history = alignment.history
    assert 2 <= len(history) < 20 and history[-1] == min(history)
    assert all(later <= earlier * (1 + 1e-12) for earlier, later in pairwise(history))
    assert history[-2] - history[-1] < 1e-3 * history[-2]
    assert 0 <= alignment.centred / history[-1] - 1 < 0.015
    assert np.abs(warp.mean(alignment.warps) - CLOCK).max() < 5e-3


@pytest.mark.parametrize("name", ["deep_squat", pytest.param("shoulder_scaption", marks=pytest.mark.slow)])
def test_going_on_beyond_the_tolerance_moves_no_warp_worth_speaking_of(name):
    motions = read_motions(recording(f"uiprmd_{name}"), where="cov_correct==1")
    directions = [motion.directions for motion in motions.motions]
    usual, long = align(directions), align(directions, tolerance=0.0, max_iterations=15)
    assert len(long.history) > len(usual.history)
    assert 1 - long.history[-1] / usual.history[-1] < 2e-3
    assert np.abs(long.warps - usual.warps).mean() * 100 < 0.1


def test_where_it_starts_decides_little():
    motions = read_motions(recording("uiprmd_side_lunge"), where="cov_correct==1")
    directions = [motion.directions for motion in motions.motions]
    one = align(directions)
    other = align([*directions[20:], *directions[:20], directions[3]])  # one more: another start, another mean
    assert np.abs(other.warps[len(directions) - 20 : -1] - one.warps[:20]).mean() * 100 < 0.5


def test_centring_costs_nothing_where_nothing_is_to_centre():
    sequences, _, _ = made_sequences(1, 60, seed=3)
    alignment = align([sequences[0], sequences[0]])
    assert alignment.centred == alignment.before == 0.0


def test_warps_are_warps_and_centred(made):
    *_, alignment = made
    warp.check(alignment.warps)
    assert np.abs(warp.mean(alignment.warps) - CLOCK).max() < 5e-3


def test_aligned_postures_are_the_sequence_at_its_warp(made):
    sequences, _, alignment = made
    assert np.allclose(alignment.directions[3], resample(sequences[3], alignment.warps[3]), atol=1e-14)
    assert np.allclose(np.linalg.norm(alignment.directions, axis=-1), 1, atol=1e-12)


def test_registration_does_not_depend_on_the_frame_of_the_room(made):
    sequences, _, alignment = made
    turned = align(list(turn(sequences, 0.9)))
    assert np.abs(turned.warps - alignment.warps).max() < 1e-9


def test_registration_does_not_depend_on_threads_or_on_order(made):
    sequences, _, alignment = made
    assert np.array_equal(align(list(sequences), n_threads=1).warps, alignment.warps)
    backwards = align(list(sequences[::-1]))
    assert np.abs(backwards.warps[::-1] - alignment.warps).max() < 1e-9


def test_callers_sequences_are_left_alone(made):
    sequences, _, _ = made
    before = sequences[:3].copy()
    align(list(sequences[:3]), max_iterations=1)
    assert np.array_equal(sequences[:3], before)


def test_a_new_repetition_is_aligned_to_the_template_that_stands(made):
    sequences, _, alignment = made
    warps, directions = align_to(list(sequences), alignment.template, alignment.reference)
    assert np.abs(warps - alignment.warps).mean() * 100 < 0.5
    assert directions.shape == alignment.directions.shape


def test_progress_counts_each_sequence_of_each_round():
    sequences, _, _ = made_sequences(3, 31, seed=1)
    seen = []
    alignment = align(
        list(sequences), n_times=31, progress=lambda done, total, label: seen.append((done, total, label))
    )
    assert len(seen) == 3 * (1 + len(alignment.history))
    assert seen[2] == (3, 3, "aligning, round 1")


def test_still_sequences_and_a_single_one_keep_their_clock():
    still = np.repeat(sphere.normalise(np.random.default_rng(0).normal(size=(1, 4, 3))), 20, axis=0)
    assert np.array_equal(align([still, still[:12]]).warps, np.stack([CLOCK, CLOCK]))
    sequences, _, _ = made_sequences(1, 40)
    assert np.array_equal(align(list(sequences)).warps, CLOCK[None])


def test_a_still_sequence_among_moving_ones_is_handled():
    sequences, _, _ = made_sequences(4, 41, seed=3)
    still = np.repeat(sequences[:1, 20], 41, axis=0)
    alignment = align([*sequences, still], n_times=41)
    warp.check(alignment.warps)
    assert np.all(np.isfinite(alignment.directions))


def test_sequences_of_any_length_are_taken():
    sequences, _, _ = made_sequences(3, 301, seed=9)
    long, short = align(list(sequences)), align([s[:: 1 + i] for i, s in enumerate(sequences)])
    assert np.abs(long.warps - short.warps).mean() * 100 < 1.0


def test_resample_goes_along_the_arc():
    quarter = np.array([[[1.0, 0, 0]], [[0, 1.0, 0]]])
    assert np.allclose(resample(quarter, np.array([0, 1 / 3, 1.0]))[1, 0], [np.cos(np.pi / 6), 0.5, 0])


@pytest.mark.parametrize(
    ("sequences", "word"),
    [
        ([], "no sequence"),
        ([np.ones((5, 2))], "sequence 0 must be"),
        ([np.ones((5, 2, 3))], "not made of unit vectors"),
        ([np.eye(3)[None].repeat(5, 0), np.eye(3)[None, :2].repeat(5, 0)], r"sequence 1 must be \(T, 3, 3\)"),
    ],
)
def test_wrong_input_is_refused(sequences, word):
    with pytest.raises(ValueError, match=word):
        align(sequences)


def test_the_turn_of_a_squat_comes_at_one_moment_of_the_common_clock():
    motions = read_motions(recording("uiprmd_deep_squat"), where="cov_correct==1")
    alignment = align([motion.directions for motion in motions.motions])
    own = motions.mark_s[:, 0] / motions.duration_s
    common = np.array([np.interp(s, gamma, CLOCK) for s, gamma in zip(own, alignment.warps)])
    assert common.std() < 0.015 < 0.04 < own.std()


ARC = np.stack([[[np.cos(a), np.sin(a), 0.0], [0, 0, 1.0]] for a in np.linspace(0, 1, 41)])
NAMED = Labels(["ana/1", "ben/2"], ["left_knee", "head"])


def test_sound_sequences_come_back():
    assert np.array_equal(checked([ARC])[0], ARC)


def test_the_mean_posture_is_the_karcher_mean():
    assert np.allclose(mean_posture(np.stack([ARC, ARC]))[0], [np.cos(0.5), np.sin(0.5), 0])


def test_a_bone_that_turns_about_is_named():
    bad = ARC.copy()
    bad[5:, 0] *= -1
    with pytest.raises(
        ValueError, match=r"sequence 1 \(ben/2\): the bone to left_knee turns about between frames 4 and 5"
    ):
        checked([ARC, bad], NAMED)
    with pytest.raises(ValueError, match="sequence 1: bone 0 turns about"):
        checked([ARC, bad])


def pair(angle):
    """Fifty postures of one bone upright, one at this angle."""
    return np.array([[[[0.0, 0, 1]]] * 50 + [[[np.sin(angle), 0, np.cos(angle)]]]])


def room(postures, base):
    return np.pi - sphere.angle(np.broadcast_to(base, postures.shape), postures).max()


@pytest.mark.parametrize("angle", [0.5, 2.0, 2.8])
def test_the_base_is_the_mean_while_no_posture_is_near_its_opposite(angle):
    mean, base = base_points(pair(angle))
    assert np.array_equal(mean, base)
    assert np.allclose(mean, sphere.mean(pair(angle)[0]))


@pytest.mark.parametrize("angle", [3.0, 3.1, np.pi])
def test_a_base_with_an_opposite_posture_is_moved_as_little_as_gives_room(angle):
    mean, base = base_points(pair(angle))
    before = room(pair(angle), mean)
    assert before < 0.25
    assert ROOM_RAD <= room(pair(angle), base) < ROOM_RAD + 0.02
    assert sphere.angle(mean, base)[0] < ROOM_RAD - before + 0.03


@pytest.mark.parametrize("n", [40, 400, 1000])
def test_where_postures_are_everywhere_the_base_has_the_most_room_there_is(n):
    rng = np.random.default_rng(n)
    points = sphere.normalise(rng.normal(size=(n, 1, 3)))
    base = base_points(points)[1]
    elsewhere = sphere.normalise(rng.normal(size=(1000, 1, 3)))
    most = min(max(room(points, other) for other in elsewhere), ROOM_RAD)
    assert room(points, base) > most - 0.02


def test_directions_that_cancel_out_have_a_base():
    base = mean_posture(np.stack([ARC, -ARC]))
    assert room(np.stack([ARC, -ARC]), base) > ROOM_RAD - 0.01


def test_a_bone_moved_to_another_base_moves_no_other():
    odd = ARC.copy()
    odd[20, 0] *= -1
    mean, base = base_points(np.stack([ARC] * 20 + [odd]))
    assert np.array_equal(mean[1], base[1])
    assert not np.array_equal(mean[0], base[0])


def test_the_base_does_not_depend_on_the_order_of_the_postures():
    points = sphere.normalise(np.random.default_rng(1).normal(size=(300, 4, 3)))
    assert np.allclose(base_points(points)[1], base_points(points[::-1])[1], atol=1e-9)


def test_exp_undoes_log_at_a_moved_base():
    points = sphere.normalise(np.random.default_rng(2).normal(0.3, 1.0, (500, 8, 3)))
    base = np.broadcast_to(base_points(points)[1], points.shape)
    assert np.abs(sphere.exp(base, sphere.log(base, points)) - points).max() < 1e-13


def test_a_posture_that_no_base_avoids_is_named():
    everywhere = np.stack([ARC, ARC])
    mean = alignable_without_room(everywhere)
    assert re.search(r"1 \(ben/2\): at 50% of its time the bone to head points opposite to its base", mean)


def alignable_without_room(uniform):
    """What is said of postures one of which is opposite to the base that was found."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(alignable, "base_points", lambda u: (u[0, 0], u[0, 0]))
        spoiled = uniform.copy()
        spoiled[1, 20, 1] = -uniform[0, 0, 1]
        with pytest.raises(ValueError) as error:
            mean_posture(spoiled, NAMED)
    return str(error.value)


@pytest.mark.parametrize(
    "durations_s, rate_hz, points",
    [
        ([2.0, 2.0, 2.0, 2.0], 60.0, 121),  # a point for each frame
        ([2.0, 2.0, 2.0, 2.0], 240.0, 121),  # of a fast camera no more than 60 a second
        ([2.0, 4.0, 6.0, 8.0], 30.0, 196),  # the third quartile, 6.5 s, at 30 a second; the mean asks for 151
        ([2.0, 4.0, 6.0, 8.0], 60.0, 301),  # the mean at 60 a second asks for more
        ([0.5, 0.5, 0.5, 0.5], 30.0, 101),  # never fewer
        ([60.0, 60.0, 60.0, 60.0], 30.0, 301),  # never more
    ],
)
def test_the_clock_has_a_point_for_each_frame_of_the_mean_and_of_a_long_recording(durations_s, rate_hz, points):
    motions = [SimpleNamespace(duration_s=s, time_s=np.linspace(0, s, round(s * rate_hz) + 1)) for s in durations_s]
    assert clock_size(SimpleNamespace(motions=motions, duration_s=np.array(durations_s))) == points
