"""Pace that depends on the state of the line, on both engines."""

import pytest
from human_plans import shipped
from twins import twins

from opsim.log import WORK

FLOOR = """
opsim: 1
name: pace
run: {horizon: 1 h, seed: 6}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m]}}
tasks: {t: {dist: lognormal, mean: 30 s, cv: 0.5}, u: {dist: lognormal, mean: 40 s, cv: 0.4}}
stations:
  first: {at: a, tasks: [t], buffer: 2}
  left: {at: b, tasks: [u], buffer: 0}
  right: {at: b, tasks: [u], buffer: 3, servers: 2}
  last: {at: a, tasks: [t]}
products:
  p: {share: 0.6, route: [first, [left, right], last]}
  q: {share: 0.4, route: [right, last]}
release: {kind: poisson, every: 35 s}
workers:
  ana: {skills: {first: 1, left: 1, right: 1}}
  ben: {skills: {right: 0.9, last: 1}, walk: 1 m/s}
  cem: {skills: {left: 1, last: 1.1}}
human: {state_pace: {model: schultz, faster: 0.3, slower: 0.2, full_at: 4}}
"""


@pytest.mark.parametrize("model", ["faster: 0.3, slower: 0.2, full_at: 4", "faster: 2", "faster: 0, slower: 0"])
def test_people_go_by_the_buffers_before_and_behind_them_as_in_the_reference(model):
    log = twins(FLOOR, ("faster: 0.3, slower: 0.2, full_at: 4", model))
    shifts = set(log.of(WORK)["pace_shift"].tolist())
    assert len(shifts) > 5 or model == "faster: 0, slower: 0"


def test_who_comes_to_help_is_asked_before_he_has_the_job():
    from twins import of_both

    of_both(shipped("paced_line", 1.0, "human: {state_pace: {model: schultz, faster: 0.4}}"))
