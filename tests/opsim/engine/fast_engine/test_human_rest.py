"""Rest by need on both engines: it begins when somebody comes free, and ends with him rested, or called away."""

import numpy as np
import pytest
from twins import twins

from opsim.log import BREAK, OFF, REST

FLOOR = """
opsim: 1
name: rests
run: {start: Mon 06:00, horizon: 4 h, seed: 3}
layout: {places: {x: [0 m, 0 m], y: [4 m, 0 m]}}
tasks: {t: {dist: lognormal, mean: 3 min, cv: 0.4}, u: {fixed: 2 min}}
stations: {a: {at: x, tasks: [t], buffer: 2}, b: {at: y, tasks: [u], buffer: 2}}
products: {p: {share: 0.5, route: [a]}, q: {share: 0.5, route: [b, a]}}
release: {kind: poisson, every: 3 min}
shifts: {d: {from: '06:00', to: '07:40', overtime: {most: 70 min}, breaks: {tea: {at: '06:50', lasts: 5 min}}, meetings: {short: {at: '07:11', lasts: 2 min}}}}
workers:
  ana: {shift: d, skills: {a: 1, b: 1}}
  ben: {shift: d, skills: {a: 1, b: 0.8}, walk: 1 m/s}
  cem: {skills: {b: 1}}
human:
  fatigue: {model: lffrm, tires_half_in: 12 min, recovers_half_in: 4 min, slows: 0.1}
  rest: {above: 0.4, until: 0.2}
"""  # noqa: E501


def rests(log):
    return log.where((log["kind"] == BREAK) & (log["cause"] == REST))


@pytest.mark.parametrize("above", ["0.25", "0.4", "0.8", "1"])
def test_people_rest_as_they_do_in_the_reference(above):
    log = twins(FLOOR, ("above: 0.4", f"above: {above}"))
    assert len(rests(log)) > 5 or float(above) > 0.5
    assert len(log.of(OFF)) >= 2


def test_rests_are_cut_short_by_breaks_meetings_and_the_end_of_the_shift():
    """And gone on with after them, where he is too tired still."""
    found = rests(twins(FLOOR, ("recovers_half_in: 4 min", "recovers_half_in: 40 min")))
    assert {50 * 60.0, 71 * 60.0} & set(found["end_s"].tolist())
    assert np.count_nonzero(np.isin(found["start_s"], [55 * 60.0, 73 * 60.0])) > 0


def test_rests_come_before_posts_are_given_out_and_beside_crews():
    turn = "human:", "rotations: {turn: {workers: [ana, ben], posts: [a, b], every: 9 min}}\nhuman:"
    assert len(rests(twins(FLOOR, turn))) > 5
