"""Learning and forgetting on both engines."""

import pytest
from human_plans import planned
from twins import of_both

from opsim.human.catalogue import models_of
from opsim.log import HELD, WORK

BENCH = """
opsim: 1
name: bench
run: {start: Fri 13:00, horizon: 2 d 17 h 30 min, seed: 2}
layout: {places: {here: [0 m, 0 m], there: [9 m, 0 m]}}
tasks: {fit: {dist: lognormal, mean: 40 s, cv: 0.3, repeat: 2}, look: {fixed: 15 s}}
stations:
  one: {at: here, tasks: [fit, look], buffer: 1, breakdowns: {jam: {every: {dist: exponential, mean: 3 min}, repair: {fixed: 70 s}}}}
  two: {at: there, tasks: [look, fit], buffer: 2}
products: {part: {route: [one, two]}}
release: {kind: saturated}
shifts: {early: {from: 06:00, to: 14:00, days: [Mon, Fri], breaks: {tea: {at: 13:20, lasts: 3 min}}, at_break: resume_any}}
workers:
  ana: {skills: {one: 1.0, two: 0.9}, shift: early, experience: {fit: 7}}
  ben: {skills: {one: 1.1, two: 1.0}, shift: early, walk: 1 m/s}
"""  # noqa: E501
LEARNING = "learning: {model: wright, rate: 0.8, measured_at: 12}"


@pytest.mark.parametrize("model", models_of("learning"))
def test_people_learn_as_they_do_in_the_reference(model):
    log = of_both(planned(BENCH, f"human: {{learning: {{model: {model}}}}}"))
    seconds = log.of(WORK).duration_s
    assert len(seconds) > 100 and seconds[:20].mean() > seconds[-100:].mean()


@pytest.mark.parametrize(
    "forgetting",
    ["forgotten_in: never", "forgotten_in: 40 d", "forgotten_in: 1 d", "least_pause: 0 s, forgotten_in: 30 min"],
)
def test_people_forget_as_they_do_in_the_reference(forgetting):
    """Over a weekend, in breaks, and where they are broken off before anything is done, or wait for a repair."""
    log = of_both(planned(BENCH, f"human: {{{LEARNING}, forgetting: {{model: lfcm, {forgetting}}}}}"))
    pieces = log.of(WORK)
    assert (pieces["progress_to"] < 1.0).sum() > 2 and len(log.of(HELD)) > 2
