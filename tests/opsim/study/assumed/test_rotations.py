"""What the sheet says of job rotation."""

import pytest
from plans import plan

from opsim.study.assumptions.assignment import rotations

CELL = """
opsim: 1
name: cell
run: {horizon: 1 h}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 1 s}}
stations: {cut: {at: a, tasks: [t]}, pack: {at: a, tasks: [t]}}
products: {part: {route: [cut, pack]}}
release: {kind: poisson, every: 9 s}
workers: {v: {skills: {cut: 1.0, pack: 1}}, w: {like: v}}
rotations: {turn: {workers: [w, v], posts: [cut, pack], every: 2 h}}
"""


@pytest.mark.parametrize(
    ("when", "said"),
    [
        (
            "every: 2 h",
            "turn: w, v share 2 posts, and change every 2 h from the start of the run, work time or not, each",
        ),
        (
            "after: 50",
            "change when 50 operations were done at one of the posts, by whomever, each to the next post; what",
        ),
        (
            "rule: least_time",
            "after every operation at one of the posts, a post going to who was there for the shortest",
        ),
    ],
)
def test_the_sheet_says_when_people_change_posts_and_who_goes_where(when, said):
    ((topic, words),) = rotations(plan(CELL.replace("every: 2 h", when)))
    assert topic == "rotation" and said in words


def test_nothing_is_said_where_nobody_changes_posts():
    assert list(rotations(plan(CELL.replace("rotations:", "#")))) == []
