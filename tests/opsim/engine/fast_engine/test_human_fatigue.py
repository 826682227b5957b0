"""Fatigue on both engines: how long it takes to tire, how long to recover, in pieces and as a whole."""

import pytest
from human_plans import planned
from twins import of_both

from opsim.log import BREAK, WORK

FLOOR = """
opsim: 1
name: tired
run: {start: Mon 06:00, horizon: 90 min, seed: 4}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
shifts: {day: {from: '06:00', to: '07:20', breaks: {tea: {at: '06:31', lasts: 4 min}}, at_break: resume_any}}
tasks: {cut: {dist: lognormal, mean: 50 s, cv: 0.3}, drill: {dist: gamma, mean: 30 s, cv: 0.5, repeat: 2}}
stations:
  one: {at: a, tasks: [cut], buffer: 2, breakdowns: {jam: {every: {fixed: 4 min}, repair: {fixed: 40 s}}}}
  two: {at: b, tasks: [drill, cut], buffer: 1}
products: {p: {share: 0.5, route: [one, two]}, q: {share: 0.5, route: [two], priority: 1}}
release: {kind: poisson, every: 70 s}
workers:
  ana: {shift: day, walk: 1 m/s, skills: {one: 1.0, two: 0.8}}
  ben: {skills: {one: 0.9, two: 1.1}}
"""
FAST = "tires_half_in: 10 min, recovers_half_in: 3 min, slows: 0.7"


@pytest.mark.parametrize("acts_on", ["posture", "time"])
def test_people_tire_as_they_do_in_the_reference(acts_on):
    log = of_both(planned(FLOOR, f"human: {{acts_on: {acts_on}, fatigue: {{model: lffrm, {FAST}}}}}"))
    work = log.of(WORK)
    assert (work["progress_to"] < 1.0).any() and len(log.of(BREAK))
    assert (work["pace_shift"].max() > 0.1) == (acts_on == "posture")


@pytest.mark.parametrize("fatigue", ["tires_half_in: never", "slows: 0", "tires_half_in: 1 s, slows: 10"])
def test_so_do_those_who_never_tire_or_at_once(fatigue):
    of_both(planned(FLOOR, f"human: {{fatigue: {{model: lffrm, {fatigue}}}}}"))
