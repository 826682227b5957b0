"""Where a job has a card, as it is read from the points it was at."""

import pytest
from plans import plan

from opsim.plan.compile import has_card

FLOOR = """
opsim: 1
name: ways
run: {horizon: 100 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 1 s, automatic: true}}
stations: {a: {at: hall, tasks: [t]}, b: {at: hall, tasks: [t]}, c: {at: hall, tasks: [END]}, d: {at: hall, tasks: [t]}}
products: {p: {route: [a, b, c, d]}}
cards: {loop: {n: 1, from: b, to: c}}
release: {kind: poisson, every: 5 s}
"""
A, B, C, D = range(4)


@pytest.mark.parametrize(
    "end, points, has",
    [
        ("t", [A, B, B, C, D], [0, 1, 1, 1, 0]),
        ("t", [A, B, A, B, C, D], [0, 1, 1, 1, 1, 0]),  # sent back from within the loop
        ("", [A, B, D], [0, 1, 0]),  # c was passed between
        ("", [A, B, A, B, D], [0, 1, 0, 1, 0]),
    ],
)
def test_a_card_is_had_from_where_the_loop_begins_until_its_end_is_left_or_passed(end, points, has):
    p = plan(FLOOR.replace("END", end))
    assert has_card(p.cards[0], 0, p, points) == [bool(one) for one in has]
