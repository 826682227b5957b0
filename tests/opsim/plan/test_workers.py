"""Workers of a plan: their bodies reach the models, and what nobody reads is said."""

import numpy as np
from plans import HERE, loaded, plan

from opsim.engine.floor import run_plan
from opsim.log import WORK
from opsim.plan import compile_plan
from opsim.plan.model_warnings import unread
from opsim.scenario.read import scenarios_in

CELL = """
opsim: 1
name: cell
run: {horizon: 30 min, seed: 5}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  squat: {emulator: moves/deep_squat}
  raise: {emulator: moves/shoulder_scaption}
  label: {dist: lognormal, mean: 12 s, cv: 0.3, between_share: 0.4}
stations: {low: {at: a, tasks: [squat], buffer: 2}, high: {at: a, tasks: [raise]}, desk: {at: a, tasks: [label]}}
products: {box: {route: [low, high, desk]}}
release: {kind: saturated}
workers:
  ana: {height: 1.62 m, mass: 58 kg, age: 41, sex: f, skills: {low: 1, high: 1, desk: 1}}
  ben: {skills: {desk: 1}}
overrides:
  quick: {workers.ana.pace: 1.25}
  person: {workers.ana.person: s05}
scenarios: {base: [], quick: [quick], person: [person]}
"""
PLANS = {name: compile_plan(one) for name, one in scenarios_in(CELL.encode(), HERE / "test.yaml").items()}


def durations(variant, task):
    p = PLANS[variant]
    work = run_plan(p).of(WORK)
    rows = (work["task"] == [one.name for one in p.tasks].index(task)) & (work["progress_to"] == 1)
    return work.duration_s[rows & (work["worker"] == 0)]


def test_all_that_is_known_of_a_body_is_in_the_plan():
    ana, ben = PLANS["quick"].workers
    assert (ana.body.height_m, ana.body.mass_kg, ana.body.age_years, ana.body.sex, ana.body.pace) == (
        1.62,
        58.0,
        41.0,
        "f",
        1.25,
    )
    assert ben.body.said == ()


def test_pace_changes_emulated_times_and_no_others():
    """A quarter faster than the typical person, whoever she was before: her mean is that of the model at this pace."""
    squat = next(task.model for task in PLANS["quick"].tasks if task.name == "squat")
    typical_s = squat.mean_duration_s(squat.new_worker())
    asked_s = squat.mean_duration_s(squat.draw_worker(np.random.default_rng(0), PLANS["quick"].workers[0].body))
    assert abs(asked_s / (typical_s / 1.25) - 1) < 0.02
    quick_s = durations("quick", "squat")
    assert abs(quick_s.mean() - asked_s) < 4 * quick_s.std() / quick_s.size**0.5
    n = min(durations(variant, "label").size for variant in ("base", "quick"))
    assert np.array_equal(durations("base", "label")[:n], durations("quick", "label")[:n])


def test_a_recorded_person_takes_his_own_time():
    squat = next(task.model for task in PLANS["person"].tasks if task.name == "squat")
    times_s = durations("person", "squat")
    assert abs(times_s.mean() - squat.mean_duration_s("s05")) < 4 * times_s.std() / times_s.size**0.5


def test_a_task_that_does_not_know_the_person_is_named():
    assert unread(PLANS["person"]) == [
        "raise was recorded without s05 (ana): there they move as people drawn from the population"
    ]
    assert unread(plan(CELL.replace("age: 41", "person: s03"))) == []


def test_a_pace_that_no_task_reads_is_said():
    says = "the pace of ben changes nothing: none of their tasks is emulated; rate them by their skills"
    (warning,) = unread(plan(CELL.replace("ben: {", "ben: {pace: 1.1, ")))
    assert warning.startswith(says)
    assert unread(PLANS["quick"]) == []


def test_workers_without_anything_said_are_no_warning():
    assert unread(plan(loaded_text())) == []


def loaded_text():
    return CELL.replace("height: 1.62 m, mass: 58 kg, age: 41, sex: f, ", "")


def test_an_age_is_years_with_or_without_the_word():
    ages = [loaded(CELL.replace("age: 41", f"age: {said}")).scenario.workers["ana"].age_years for said in AGES]
    assert ages == [41.0, 41.0, 1.0 * 41.5]


AGES = ("41", "41 years", "41.5")
