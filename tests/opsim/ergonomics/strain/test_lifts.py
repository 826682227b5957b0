"""Lifts found in frames."""

from dataclasses import replace

import numpy as np
import pytest

from opsim.ergonomics.angles import AT
from opsim.ergonomics.strain.lifting import Lifted
from opsim.plan.tasks import Handling
from tests.opsim.ergonomics.made_frames import hands, made_frames
from tests.opsim.ergonomics.made_work import BEND, COUNT, made_plan


def loaded_plan(load_kg=10.0, grip="good", task=BEND):
    plan = made_plan()
    tasks = list(plan.tasks)
    tasks[task] = replace(tasks[task], handling=Handling(load_kg=load_kg, grip=grip))
    return replace(plan, tasks=tuple(tasks))


def lifts_of(*stretches, plan=None):
    fold = Lifted(loaded_plan() if plan is None else plan)
    for frames in stretches:
        fold.add(frames)
    return fold.lifts()


def test_a_lift_goes_from_the_first_to_the_last_posture_with_the_load():
    """Empty hands at 0.9 m; taken at 0.2 m with bent knees, let go at 1.0 m to the side; empty again."""
    up = [0.9, 0.2, 0.6, 1.0, 0.9]
    measures = hands(np.array(up), [0.3, 0.3, 0.3, 0.4, 0.3], [0.0, 0.0, 0.0, 0.3, 0.0], [0, 80, 40, 10, 0])
    found = lifts_of(made_frames(5, seconds=0.5, task=BEND, carrying=[False, True, True, True, False], **measures))
    assert found.worker.tolist() == [0] and found.task.tolist() == [BEND]
    assert (found.start_s[0], found.end_s[0]) == (0.5, 2.0)
    assert found.height_m.tolist() == [[0.2, 1.0]]
    assert found.travel_m == pytest.approx([0.8])
    assert found.horizontal_m[0] == pytest.approx([0.3, 0.5])
    assert found.asymmetry_deg[0] == pytest.approx([0.0, np.rad2deg(np.arctan2(0.3, 0.4))])
    assert found.knee_deg.tolist() == [[80.0, 10.0]]


def test_what_stays_within_ten_centimetres_is_carried_and_not_lifted():
    for top, n in ((1.09, 0), (1.11, 1)):
        frames = made_frames(2, task=BEND, carrying=True, **hands(np.array([1.0, top])))
        assert lifts_of(frames).worker.size == n


def test_each_performance_is_a_lift_of_its_own_and_a_load_that_nobody_told_is_none():
    frames = made_frames(
        4, task=[BEND, BEND, COUNT, COUNT], k=[0, 0, 0, 0], carrying=True, **hands(np.r_[0.2, 1, 0.2, 1])
    )
    again = made_frames(2, task=BEND, k=1, start_s=10.0, carrying=True, **hands(np.r_[1.0, 0.2]))
    found = lifts_of(frames, again)
    assert found.start_s.tolist() == [0.0, 10.0] and found.height_m[:, 0].tolist() == [0.2, 1.0]


def test_a_performance_over_the_edge_of_a_stretch_is_one_lift():
    whole = made_frames(4, task=BEND, k=3, carrying=True, **hands(np.array([0.2, 0.4, 0.8, 1.2])))
    halves = lifts_of(whole.some(slice(0, 2)), whole.some(slice(2, 4)))
    assert halves.height_m.tolist() == lifts_of(whole).height_m.tolist() == [[0.2, 1.2]]


def test_postures_without_hands_are_passed_over_and_one_hand_will_do():
    frames = made_frames(3, task=BEND, carrying=True, **hands(np.array([0.1, 0.3, 1.0])))
    frames.measures[0] = np.nan
    frames.measures[:, AT["left_hand_up_m"]] = np.nan
    assert lifts_of(frames).height_m.tolist() == [[0.3, 1.0]]
    frames.measures[:] = np.nan
    assert lifts_of(frames).worker.size == 0


def test_nobody_who_walks_or_waits_lifts():
    assert lifts_of(made_frames(2, task=[-1, -2], carrying=True, **hands(np.array([0.2, 1.0])))).worker.size == 0
