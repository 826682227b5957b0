"""How fast bodies gather dose: against many draws, by task and by worker."""

import numpy as np
import plans
import pytest

from opsim.ergonomics.shift import worst as dose_rates
from opsim.ergonomics.shift.worst import DoseRates, dose_rates_of

CELL = """
opsim: 1
name: doses
run: {horizon: 1 h, seed: 3}
libraries: {bench: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  bend: {emulator: bench/stoop, load: 8 kg}
  look: {emulator: bench/inspect, load: 0 kg}
  wait: {fixed: 5 s}
  bake: {fixed: 9 s, automatic: true}
stations: {s: {at: a, tasks: [bend, look, wait, bake]}}
products: {p: {route: [s]}}
release: {kind: poisson, every: 50 s}
workers: {ana: {skills: {s: 1}}, ben: {skills: {s: 1}}}
"""
BAKE, BEND, LOOK, WAIT = range(4)


@pytest.fixture(scope="module")
def plan():
    return plans.plan(CELL)


@pytest.fixture
def rates(plan):
    return DoseRates(plan, 0)


def test_a_stoop_weighs_more_than_a_look_and_what_nobody_has_seen_weighs_nothing(rates):
    bend, look = rates.per_s(0, BEND), rates.per_s(0, LOOK)
    assert 1 <= look < 3 < bend <= 7
    assert rates.per_s(0, WAIT) == rates.per_s(0, BAKE) == 0.0


def test_a_few_draws_stand_within_a_tenth_of_many(plan, rates, monkeypatch):
    monkeypatch.setattr(dose_rates, "N_DRAWS", 256)
    many = DoseRates(plan, 0)
    for worker, task in ((0, BEND), (1, BEND), (0, LOOK), (1, LOOK)):
        assert abs(rates.per_s(worker, task) - many.per_s(worker, task)) < 0.1


def test_each_worker_has_rates_of_his_own_and_the_order_of_asking_changes_none(plan, rates):
    assert rates.per_s(0, BEND) != rates.per_s(1, BEND)
    other = DoseRates(plan, 0)
    assert [other.per_s(w, BEND) for w in (1, 0)] == [rates.per_s(w, BEND) for w in (1, 0)]


def test_the_mean_is_weighted_by_time():
    """Two performances of 1 s and 3 s in two parts each, RULA 2, 2 and 4, 4: (2 + 12) / 4 = 3.5."""

    class Block:
        duration_s = np.array([1.0, 3.0])

    class Task:
        name, handling = "bend", None

    plan = plans.plan(CELL)
    measured = np.ones((2, 2, 30))
    found = DoseRates(plan, 0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dose_rates, "N_DRAWS", 2)
        patch.setattr(dose_rates, "measures_of", lambda *_: measured)
        patch.setattr(dose_rates, "bounds_of", lambda _: None)
        rula = np.array([[2, 2], [2, 3], [4, 4], [4, 7]])
        patch.setattr(dose_rates, "score", lambda *_: type("S", (), {"rula": rula}))
        assert found._mean_rula(Block, Task) == 3.5


def test_the_rates_of_a_plan_are_kept_for_its_next_replication(plan):
    assert dose_rates_of(plan, 0) is dose_rates_of(plan, 0)
    assert dose_rates_of(plan, 1) is not dose_rates_of(plan, 0)
