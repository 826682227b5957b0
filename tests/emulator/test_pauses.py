from dataclasses import replace

import numpy as np
import pytest

from emulator.geometry import warps as warp
from emulator.geometry.alignment import align
from emulator.geometry.pauses import cut, find, moves
from emulator.motion import MotionSet
from emulator.recordings import read_motions
from emulator.synthetic.choreography import TASKS
from emulator.synthetic.tasks import make
from tests.emulator.pausing import CLOCK, pause, paused_work, shaken
from tests.recordings import recording


def test_a_set_without_pauses_is_left_as_it_is():
    motions = make("lift", 2, 3)[0]
    moving, holds = cut(motions)
    assert moving is motions and holds == ((),) * 6


def test_what_is_cut_out_is_what_was_put_in():
    motion = make("walk", 1, 1, seed=2)[0].motions[0]
    paused, at = pause(motion, 0.3, 60)
    moving, ((hold,),) = cut(MotionSet("walk", (paused,), ("halfway",)))
    (again,) = moving.motions
    assert hold.first == at and hold.last == at + 60
    assert np.array_equal(again.directions, motion.directions)
    assert np.allclose(again.time_s, motion.time_s, atol=1e-12)
    assert np.allclose(again.root_m, motion.root_m) and np.allclose(again.mark_s, motion.mark_s)
    assert hold.dwell_s == pytest.approx(paused.duration_s - motion.duration_s)
    assert hold.moving_share == pytest.approx(at / (len(motion.time_s) - 1))
    assert hold.mark_share == (1.0,)


def test_pauses_at_the_ends_lie_at_the_ends_of_the_moving_time():
    motion = make("lift", 1, 1, seed=2)[0].motions[0]
    both = pause(pause(motion, 1.0, 40)[0], 0.0, 50)[0]
    moving, ((start, end),) = cut(MotionSet("lift", (both,), ("grasp", "set_down")))
    assert (start.moving_share, end.moving_share) == (0.0, 1.0)
    assert start.mark_share == (1.0, 1.0) and end.mark_share == (0.0, 0.0)
    assert moving.motions[0].duration_s + start.dwell_s + end.dwell_s == pytest.approx(both.duration_s)


def test_a_pause_that_drifts_leaves_no_jump():
    motion = make("walk", 1, 1, seed=2)[0].motions[0]
    paused, at = pause(motion, 0.3, 100)
    step = np.linalg.norm(np.diff(motion.directions, axis=0), axis=-1).max()
    drifting = paused.directions.copy()
    angle = np.clip(np.arange(len(drifting)) - at, 0, 100)[:, None] * 0.0004
    drifting[..., 0], drifting[..., 2] = (
        np.cos(angle) * paused.directions[..., 0] - np.sin(angle) * paused.directions[..., 2],
        np.sin(angle) * paused.directions[..., 0] + np.cos(angle) * paused.directions[..., 2],
    )
    from dataclasses import replace

    moving, (holds,) = cut(MotionSet("walk", (replace(paused, directions=drifting),), ("halfway",)))
    assert len(holds) == 1 and holds[0].dwell_s > 1.0
    assert np.linalg.norm(np.diff(moving.motions[0].directions, axis=0), axis=-1).max() < 1.5 * step


def error_frames(paused, warps, moving, holds):
    """Frames between where the warps put each moment of the common clock and the truth, away from the pause itself."""
    truth = warp.centre(paused.truth.warps)
    site = np.interp(CLOCK, warp.mean(paused.truth.warps), CLOCK)
    error, clear = [], np.abs(site - 0.4) > 0.03
    for i, (motion, mine) in enumerate(zip(moving.motions, holds)):
        own = warp.evaluate(warps[i], CLOCK)
        found_s = own * motion.duration_s + sum(hold.dwell_s * (own > hold.moving_share) for hold in mine)
        true_s = paused.original.motions[i].duration_s * truth[i] + paused.dwell_s[i] * (site > 0.4)
        rate_hz = (len(motion.time_s) - 1) / motion.duration_s
        error.append(np.abs(found_s - true_s)[clear] * rate_hz)
    return np.array(error)


@pytest.mark.parametrize("task", ["lift", "reach"])
def test_cutting_takes_the_error_of_a_60_frame_pause_from_over_20_frames_to_below_3(task):
    paused = paused_work(task, 0.4)
    uncut = align([m.directions for m in paused.motions.motions]).warps
    wrong = error_frames(paused, uncut, paused.motions, [()] * len(paused.motions))
    moving, holds = cut(paused.motions)
    right = error_frames(paused, align([m.directions for m in moving.motions]).warps, moving, holds)
    assert [len(mine) for mine in holds] == [int(dwell_s > 0) for dwell_s in paused.dwell_s]
    pauses = paused.dwell_s > 0
    assert wrong[pauses].max() > 20 and right[pauses].max() < 3
    assert wrong[~pauses].mean() > 4 * right[~pauses].mean()  # the pauses of some bend the warps of all
    assert right.mean() < 0.7


def test_marks_fall_on_one_point_of_the_common_clock_again():
    paused = paused_work("walk", 0.5)
    spread = []
    for motions in (paused.motions, cut(paused.motions)[0], paused.original):
        warps = align([m.directions for m in motions.motions]).warps
        clock = np.linspace(0, 1, warps.shape[1])
        at = [np.interp(m.mark_s / m.duration_s, gamma, clock) for m, gamma in zip(motions.motions, warps)]
        spread.append(np.std(at, axis=0))
    uncut, mended, never = spread
    assert np.all(mended < 1.1 * never) and uncut.max() > 1.5 * never.max()


SIX = (
    "sit_to_stand",
    "deep_squat",
    "side_lunge",
    "inline_lunge",
    "shoulder_abduction",
    "shoulder_scaption",
)


@pytest.mark.parametrize("task", TASKS)
def test_a_pause_is_found_to_the_frame_and_nothing_else_is(task):
    rng = np.random.default_rng(0)
    for motion in make(task, 2, 3, seed=1)[0].motions:
        assert find(motion) == []
        paused, at = pause(motion, rng.uniform(0.1, 0.9), 60)
        ((first, last),) = find(paused)
        assert abs(first - at) <= 5 and abs(last - at - 60) <= 5


@pytest.mark.parametrize("noise_rad", [0.002, 0.005])
@pytest.mark.parametrize("task", ["lift", "walk", "reach"])
def test_a_pause_is_found_through_tracking_noise(task, noise_rad):
    rng = np.random.default_rng(0)
    for motion in make(task, 2, 3, seed=1)[0].motions:
        assert find(shaken(motion, noise_rad, rng)) == []
        paused, at = pause(motion, rng.uniform(0.2, 0.8), 60, noise_rad, rng)
        ((first, last),) = find(paused)
        assert abs(first - at) <= 9 and abs(last - at - 60) <= 9


def test_stillness_at_the_start_and_at_the_end_is_found():
    motion = make("lift", 1, 1, seed=1)[0].motions[0]
    early, late = (pause(motion, share, 50)[0] for share in (0.0, 1.0))
    assert find(early)[0][0] == 0 and abs(find(early)[0][1] - 50) <= 5
    assert find(late)[-1][1] == len(late.time_s) - 1


def test_a_pause_shorter_than_a_quarter_second_is_a_soft_turn():
    motion = make("walk", 1, 1, seed=1)[0].motions[0]
    rate_hz = (len(motion.time_s) - 1) / motion.duration_s
    assert find(pause(motion, 0.4, round(0.2 * rate_hz))[0]) == []
    assert len(find(pause(motion, 0.4, round(0.3 * rate_hz))[0])) == 1


def test_how_long_it_stands_still_does_not_change_what_is_still():
    motion = make("inspect", 1, 1, seed=1)[0].motions[0]
    ((short_first, _),), ((long_first, _),) = (find(pause(motion, 0.6, n)[0]) for n in (40, 2000))
    assert short_first == long_first


def test_a_body_that_is_carried_in_one_posture_does_not_pause():
    motion, _ = pause(make("lift", 1, 1, seed=1)[0].motions[0], 0.5, 60)
    root = motion.root_m.copy()
    root[:, 0] += 0.5 * motion.time_s
    assert len(find(motion)) == 1 and find(replace(motion, root_m=root)) == []


def test_what_never_moves_has_no_pauses():
    motion = make("lift", 1, 1, seed=1)[0].motions[0]
    still = replace(motion, directions=np.repeat(motion.directions[:1], len(motion.time_s), axis=0))
    assert moves(motion) and not moves(still) and find(still) == []
    shaky = shaken(still, 0.005, np.random.default_rng(0))
    assert not moves(shaky) and find(shaky) == []


@pytest.mark.parametrize("name", SIX)
def test_recorded_exercise_has_no_pauses(name):
    motions = read_motions(recording(f"uiprmd_{name}"), where=None)
    assert [motion.name for motion in motions.motions if find(motion)] == []


def test_a_pause_put_into_a_recording_is_found():
    for motion in read_motions(recording("uiprmd_deep_squat"), where="cov_correct==1").motions[:8]:
        ((first, last),) = find(pause(motion, 0.3, 50, 0.001, np.random.default_rng(0))[0])
        assert abs(first - 0.3 * (len(motion.time_s) - 1)) <= 4 and abs(last - first - 50) <= 6
