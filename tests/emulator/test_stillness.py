from dataclasses import replace

import numpy as np
import pytest

from emulator.geometry.pauses import find, moves
from emulator.recordings import read_motions
from emulator.synthetic.choreography import TASKS
from emulator.synthetic.tasks import make
from tests.emulator.pausing import pause, shaken
from tests.recordings import recording

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
