from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from opsim.ergonomics.scores.scoring import NOTHING_OPEN
from opsim.ergonomics.shift.movement import scored_movements
from opsim.report.motion.scoring import LEVELS, MOST_ROWS, SLIM_IN, WIDE_IN, course_svg, level_colour
from tests.opsim.ergonomics.shift.test_movement import movement


def test_scores_have_the_colour_of_their_action_level():
    """RULA 1-2, 3-4, 5-6, 7; REBA 1, 2-3, 4-7, 8-10, 11-15; OWAS 1, 2, 3, 4."""
    none, later, soon, _, now = LEVELS
    assert [level_colour("rula", score) for score in (1, 2, 3, 4, 5, 6, 7)] == [none] * 2 + [later] * 2 + [soon] * 2 + [
        now
    ]
    assert [level_colour("reba", score) for score in (1, 3, 4, 8, 11)] == list(LEVELS)
    assert [level_colour("owas", score) for score in (1, 2, 3, 4)] == [none, later, soon, now]


def test_a_row_shows_both_ends_of_an_interval():
    """Half of it in the colour of RULA 2, half in that of 7."""
    (one,) = scored_movements([movement(0.0, 0.0)], NOTHING_OPEN)
    wide = replace(one, scores=replace(one.scores, rula=np.array([[2, 7]] * 2, np.int8)))
    picture = course_svg([wide, wide], {}).decode()
    none, now = f"fill: {LEVELS[0]}", f"fill: {LEVELS[4]}"
    alone = replace(one, scores=replace(one.scores, rula=np.array([[2, 2]] * 2, np.int8)))
    assert picture.count(now) == course_svg([alone, alone], {}).decode().count(now) + 2 and none in picture


def test_a_slim_picture_is_as_high_and_less_wide():
    made = scored_movements([movement(0.0, 70.0)], NOTHING_OPEN)
    broad, slim = (ElementTree.fromstring(course_svg(made, {}, wide)).get("viewBox") for wide in (WIDE_IN, SLIM_IN))
    assert float(slim.split()[2]) < 0.5 * float(broad.split()[2]) and slim.split()[3] == broad.split()[3]


@pytest.mark.parametrize("n", [1, 2, MOST_ROWS + 1])
def test_a_picture_of_one_movement_and_of_many(n):
    made = [movement(0.0, 70.0, float("nan"), name=f"take {k}") for k in range(n)]
    picture = course_svg(scored_movements(made, NOTHING_OPEN), {(0, 1): "A"})
    root = ElementTree.fromstring(picture)
    assert root.tag.endswith("svg")
    assert n > 2 or picture == course_svg(scored_movements(made, NOTHING_OPEN), {(0, 1): "A"})


def test_a_picture_without_a_letter_is_of_the_first_movement():
    assert course_svg(scored_movements([movement(float("nan"))], NOTHING_OPEN), {}).startswith(b"<?xml")
