from dataclasses import replace

import numpy as np
import pytest

from opsim.report.sections.walking import LONGEST_M, draw_walk, words
from opsim.report.sections.walking import FootWalk as Walk
from tests.made_result import SCRIPT
from tests.opsim.made_walks import SKELETON
from tests.opsim.made_walks import Walk as Model


def made_walk(distance_m=4.0, speed=1.0, worker="ana", n_times=121):
    """A walk in even steps of 0.5 m, feet that stay."""
    condition = {"distance_m": distance_m, "speed_m_per_s": speed}
    drawn = Model().sample(1, np.random.default_rng(0), condition=condition)
    positions_m, contact = drawn.positions_m(n_times=n_times)[0], drawn.contact(n_times=n_times)[0]
    return Walk(worker, "bench to rack", distance_m, distance_m / speed, positions_m, contact, SKELETON)


def test_feet_that_stay_do_not_slide():
    assert made_walk().slide_mm < 1e-9


def test_a_foot_that_creeps_while_it_bears_is_said_to_slide():
    """By 1 mm a frame, both feet: the longest stance is 0.5 s, two steps of four each a second."""
    walk = made_walk()
    creeping = walk.positions_m + np.array([0.001, 0, 0]) * np.arange(121)[:, None, None]
    slid = replace(walk, positions_m=creeping).slide_mm
    longest = max(stance.stop - stance.start for side in (0, 1) for stance in walk.stances(side))
    assert slid == pytest.approx(longest - 1, rel=0.03)


def test_a_foot_that_rolls_over_its_toe_does_not_slide():
    walk = made_walk()
    ankle = list(SKELETON.names).index("left_ankle")
    rolled = walk.positions_m.copy()
    rolled[:, ankle, 0] += 0.05 * np.sin(np.arange(121))
    assert replace(walk, positions_m=rolled).slide_mm < 1e-9


def test_steps_are_counted_and_measured_from_one_foot_to_the_other():
    walk = made_walk()
    assert walk.footfalls_m == pytest.approx(0.5 * np.arange(1, 9)) and walk.step_length_m == pytest.approx(0.5)
    assert walk.cadence_per_min == pytest.approx(8 * 60 / 4)


def test_a_walk_in_any_direction_is_drawn_from_left_to_right():
    walk = made_walk()
    turn = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1.0]])
    turned = replace(walk, positions_m=walk.positions_m @ turn + np.array([3.0, -2.0, 0.0]))
    assert np.allclose(turned.along_m, walk.along_m)
    assert turned.slide_mm == pytest.approx(walk.slide_mm, abs=1e-9)


def test_the_words_say_speed_step_cadence_and_sliding():
    said = words(made_walk(speed=1.25))
    assert said.startswith("1.25 m/s, steps of 0.50 m, 150 a minute; ") and "slide by at most 0" in said


def test_a_picture_is_the_same_for_the_same_walk_and_holds_no_foreign_markup():
    picture = draw_walk(made_walk(worker=SCRIPT), 4.0)
    assert picture == draw_walk(made_walk(worker=SCRIPT), 4.0) and picture.startswith(b"<svg")
    assert SCRIPT.encode() not in picture


@pytest.mark.parametrize("distance_m", [0.6, 30.0])
def test_short_and_long_walks_are_drawn_too(distance_m):
    walk = made_walk(distance_m, n_times=901)
    assert len(draw_walk(walk, distance_m)) < 3e6 and (distance_m < LONGEST_M or walk.along_m[-1, 0, 0] > LONGEST_M)
