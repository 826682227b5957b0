"""Switches of variability in a run: what rows say, and that all variants have the same random numbers."""

import numpy as np
import pytest
from plans import HERE, loaded

from opsim.clock import on_grid
from opsim.engine.draws import Draws
from opsim.engine.floor.run import run_plan
from opsim.laws.audit import CHECKS, audit
from opsim.log import WORK
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in
from opsim.subjects.tasks.variability import Switched
from opsim.tasks import Gamma

MIXED = """
opsim: 1
name: mixed
run: {horizon: 40 min, seed: 5}
libraries: {moves: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [9 m, 4 m]}}
tasks:
  label: {dist: lognormal, mean: 12 s, cv: 0.3, between_share: 0.4}
  pack:  {dist: gamma, mean: 9 s, cv: 0.4, between_share: 0.6, repeat: 2}
  lift:  {emulator: moves/lift}
  press: {dist: gamma, mean: 8 s, cv: 0.5, automatic: true}
stations:
  one: {at: a, tasks: [label, lift], buffer: 3}
  two: {at: b, tasks: [pack, press], servers: 2, buffer: 3}
  six: {at: c, tasks: [lift], buffer: 3}
products: {box: {route: [one, two, six]}}
release: {kind: poisson, every: 25 s}
workers:
  ana: {height: 1.62 m, skills: {one: 1.1, two: 1.0, six: 0.9}}
  ben: {skills: {two: 0.8, six: 1.0, one: 1.0}}
overrides:
  within_only: {run.variability: within_only}
  between_only: {run.variability: between_only}
  none: {run.variability: none}
  shuffled: {run.variability: shuffled}
  full: {run.variability: full}
  third: {workers.cai: {like: ben}}
scenarios:
  base: []
  full: [full]
  within_only: [within_only]
  between_only: [between_only]
  none: [none]
  shuffled: [shuffled]
  third_within_only: [within_only, third]
  third_between_only: [between_only, third]
  third_none: [none, third]
  third_shuffled: [shuffled, third]
"""
PLANS = {name: compile_plan(one) for name, one in scenarios_in(MIXED.encode(), HERE / "test.yaml").items()}
SWITCHES = ("within_only", "between_only", "none", "shuffled")


def drawn(plan, n=200):
    """Durations by task and worker, (n,), without the queueing between them."""
    draws = Draws(plan, 0)
    return {
        (task.name, worker.name): np.array([draws.duration_s(t, w, k) for k in range(n)])
        for t, task in enumerate(plan.tasks)
        for w, worker in enumerate(plan.workers)
    }


def same_rows(variant, other):
    one, two = run_plan(PLANS[variant]).columns, run_plan(PLANS[other]).columns
    return all(one[column].tobytes() == two[column].tobytes() for column in one)


def test_full_goes_through_no_switch_and_is_the_default():
    for name in ("base", "full"):
        assert not any(isinstance(task.model, Switched) for task in PLANS[name].tasks)
    assert same_rows("full", "base")
    assert isinstance(PLANS["none"].tasks[0].model, Switched)


def test_with_none_every_row_of_work_lasts_the_mean_over_the_rating():
    plan = PLANS["none"]
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    work = log.of(WORK)
    whole = (work["progress_from"] == 0) & (work["progress_to"] == 1)
    assert whole.sum() > 200 and set(work["task"][whole].tolist()) == {0, 1, 2, 3}
    for row in np.flatnonzero(whole):
        task, worker, station = (int(work[column][row]) for column in ("task", "worker", "station"))
        rating = plan.workers[worker].rating[station] if worker >= 0 else 1.0
        assert work.duration_s[row] == on_grid(plan.tasks[task].model.mean_duration_s() / rating)


def test_shuffling_bodies_moves_no_event_by_a_bit():
    assert same_rows("shuffled", "base")
    assert not same_rows("within_only", "base")


def test_between_only_leaves_no_variance_within_a_worker_and_some_between():
    times = drawn(PLANS["between_only"])
    assert all(np.ptp(values) == 0 for values in times.values())
    for task in ("label", "lift", "pack"):
        assert times[task, "ana"][0] != times[task, "ben"][0]


def test_within_only_is_full_times_one_factor_a_worker():
    full, within = drawn(PLANS["base"]), drawn(PLANS["within_only"])
    for key, values in within.items():
        factors = values / full[key]
        assert np.ptp(factors) < 1e-12
        assert (factors[0] != 1) == (key[0] != "press")


@pytest.mark.parametrize("switch", SWITCHES)
def test_an_added_worker_changes_nobody_s_draws(switch):
    two, three = drawn(PLANS[switch]), drawn(PLANS[f"third_{switch}"])
    assert len(three) == 12
    assert all(np.array_equal(values, three[key]) for key, values in two.items())


@pytest.mark.parametrize("switch", SWITCHES)
def test_every_law_holds_and_loads_stay(switch):
    plan = PLANS[switch]
    assert audit(run_plan(plan), plan) == CHECKS
    assert [task.mean_s() for task in plan.tasks] == [task.mean_s() for task in PLANS["base"].tasks]


def test_gaps_between_jobs_are_no_work_and_keep_their_spread():
    text = MIXED.replace("{kind: poisson, every: 25 s}", "{kind: renewal, every: {dist: gamma, mean: 25 s, cv: 0.5}}")
    plan = compile_plan(loaded(text, "none"))
    assert plan.release.gap == Gamma(25.0, 0.5)
