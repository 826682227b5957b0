import numpy as np
import pytest

from opsim.human.fatigue import Lffrm, Tired
from opsim.human.muscle_fatigue import JOINTS, ThreeCompartment

MODEL = Lffrm(tires_half_in_s=600.0, recovers_half_in_s=300.0)


def even(_task):
    return 1.0


def test_who_works_until_he_is_done_rests_from_then():
    # 600 s of work leave 0.5, 300 s of rest after them 0.25
    one = Tired(MODEL, even)
    one.works(100.0, 0, 700.0)
    assert one.level_at(700.0) == pytest.approx(0.5)
    assert one.level_at(1000.0) == pytest.approx(0.25)


def test_who_is_broken_off_rests_from_then():
    one = Tired(MODEL, even)
    one.works(0.0, 0, 5000.0)
    one.stops(600.0)
    assert one.level_at(900.0) == pytest.approx(0.25)


def test_asking_changes_nothing():
    asked, left_alone = Tired(MODEL, even), Tired(MODEL, even)
    for one in (asked, left_alone):
        one.works(10.0, 0, 500.0)
    for now in range(0, 800, 7):
        asked.level_at(float(now))
    assert asked.level_at(900.0) == pytest.approx(left_alone.level_at(900.0), abs=1e-12)


def test_a_piece_goes_on_in_the_middle_of_the_tasks_course():
    course = np.zeros((4, len(JOINTS)))
    course[2:, 4] = 0.6  # the back is bent in the second half
    whole, resumed = (Tired(ThreeCompartment(), lambda _task: course) for _ in range(2))
    whole.works(0.0, 0, 40.0)
    resumed.works(0.0, 0, 40.0)
    resumed.stops(20.0)
    assert resumed.level_at(20.0) == 0.0
    resumed.works(20.0, 0, 40.0, 0.5)
    assert resumed.level_at(40.0) == pytest.approx(whole.level_at(40.0), abs=1e-12) != 0.0


def test_a_task_of_which_nothing_is_known_is_a_rest():
    one = Tired(ThreeCompartment(), lambda _task: None)
    one.works(0.0, 0, 100.0)
    assert one.level_at(100.0) == 0.0


def test_the_burden_of_a_task_is_asked_for_once():
    asked = []
    one = Tired(MODEL, lambda task: asked.append(task) or 1.0)
    for start_s in (0.0, 10.0, 20.0):
        one.works(start_s, 3, start_s + 5.0)
    one.level_at(30.0)
    assert asked == [3]
