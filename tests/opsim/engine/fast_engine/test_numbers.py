"""Numbers drawn ahead by what replications before have asked for: they change no log, and few are called for."""

from dataclasses import replace

import numpy as np
import pytest
from engine_evidence.rows import first_difference
from plans import plan

from opsim.engine.fast_engine import numbers
from opsim.engine.fast_engine.random_numbers import DURATION, HOLD
from opsim.engine.fast_engine.run import Machine
from opsim.engine.floor.run import run_plan as run_simpy
from opsim.log import COLUMNS
from opsim.tasks import TimePerformances

SHOP = """
opsim: 1
name: shop
run: {horizon: 4 h, seed: 3}
layout: {places: {a: [0 m, 0 m], b: [2 m, 0 m]}}
tools: {gun: {n: 1}}
tasks:
  make: {dist: lognormal, mean: 20 s, cv: 0.3, between_share: 0.4}
  turn: {dist: gamma, mean: 15 s, cv: 0.4, between_share: 0.2}
  screw: {dist: lognormal, mean: 10 s, cv: 0.3, hold: {tool: gun, from: 0.2, to: 0.6}}
  pack: {fixed: 3 s}
stations:
  s1: {at: a, tasks: [make, screw], servers: 2, breakdowns: {jam: {every: {dist: exponential, mean: 10 min}, by: clock,
       repair: {dist: exponential, mean: 1 min}, job: resume}}}
  s2: {at: b, tasks: [turn, pack]}
products: {part: {route: [s1, s2], share: 0.7}, other: {route: [s2], share: 0.3}}
release: {kind: poisson, every: 60 s}
workers: {w1: {skills: {s1: 1.0, s2: 1.0}}, w2: {skills: {s2: 0.7, s1: 1.1}}, w3: {skills: {s1: 0.9}}}
"""


@pytest.fixture(scope="module")
def shop():
    return plan(SHOP)


@pytest.fixture(scope="module")
def wanted(shop):
    return [run_simpy(shop, replication) for replication in range(6)]


def all_equal(machine, wanted, replications):
    return [first_difference(wanted[r], machine.run(r)) for r in replications] == [""] * len(replications)


@pytest.mark.parametrize("order", [(0, 1, 2, 3, 4, 5), (5, 4, 3, 2, 1, 0), (2, 2, 0, 5, 2)], ids=str)
def test_what_ran_before_changes_no_log(shop, wanted, order):
    machine = Machine(shop)
    assert all_equal(machine, wanted, order)
    assert len(machine.numbers.recipe.blocks) >= 10, "nothing was drawn ahead"


def test_a_replication_that_is_run_again_calls_for_nothing(shop, wanted):
    machine = Machine(shop)
    machine.run(1)
    called_for = dict(machine.numbers._asked)
    assert all_equal(machine, wanted, (1,)) and machine.numbers._asked == {}
    assert machine.numbers.drawn.keys() == called_for.keys()
    assert all(machine.numbers.drawn[stream] >= 1 for stream in called_for)


@pytest.mark.parametrize("n_blocks", [0, 1, 2])
def test_what_was_drawn_ahead_and_is_not_enough_is_called_for(shop, wanted, monkeypatch, n_blocks):
    monkeypatch.setattr(numbers, "_with_spare", lambda _: n_blocks)
    machine = Machine(shop)
    for replication in (0, 1, 2, 3):
        assert all_equal(machine, wanted, (replication,)) and machine.numbers._asked


def test_what_was_used_is_drawn_the_next_time_and_little_more(shop):
    machine = Machine(shop)
    for replication in (0, 1, 0, 1):
        machine.run(replication)
    used, drawn = machine.numbers.recipe.used(), machine.numbers.recipe.blocks
    assert sum(used.values()) >= 0.5 * sum(drawn.values())
    assert all(used[stream] <= drawn[stream] for stream in used)


def test_people_who_are_redrawn_are_called_for_and_all_else_is_drawn_ahead(shop):
    redrawn = replace(shop, staffing="redrawn")
    machine = Machine(redrawn)
    for replication in (0, 1, 2, 0):
        assert first_difference(run_simpy(redrawn, replication), machine.run(replication)) == ""
    purposes = {stream >> 48 for stream in machine.numbers._asked}
    assert purposes == {DURATION, HOLD}


def test_a_log_keeps_its_numbers_while_others_are_drawn(shop):
    machine = Machine(shop)
    machine.run(0)
    log = machine.run(1)
    before = {name: log[name].copy() for name in COLUMNS}
    for replication in range(2, 6):
        machine.run(replication)
    assert all(np.array_equal(log[name], before[name], equal_nan=before[name].dtype.kind == "f") for name in COLUMNS)


class Own:
    """A plug-in's model, which is asked for each block."""

    n_asked, most = 0, 1_000_000

    def mean_duration_s(self, worker=None):
        return 20.0

    def draw_worker(self, rng, body=None):
        return None

    def sample(self, n, rng, *, worker=None, condition=None):
        self.n_asked += 1
        if self.n_asked > self.most:
            raise RuntimeError("no more")
        return TimePerformances(10.0 + rng.random(n))


def with_model(shop, model):
    return replace(shop, tasks=(replace(shop.tasks[0], model=model), *shop.tasks[1:]))


def test_of_dear_numbers_no_more_are_drawn_at_once_than_the_last_replications_all_wanted(shop):
    model, before = Own(), {0: [], 1: [], 2: []}
    made = replace(with_model(shop, model), horizon_s=12 * 3600.0)
    machine = Machine(made)
    for replication in (0, 1, 2, 3, 4, 5, 3):
        log, model.n_asked = run_simpy(made, replication), 0
        assert first_difference(log, machine.run(replication)) == ""
        drawn = 0
        for worker in np.unique(log["worker"][log["task"] == 0]).tolist():
            wanted = 1 + log["k"][(log["task"] == 0) & (log["worker"] == worker)].max() // 64
            drawn += max(wanted, min(before[worker][-4:], default=0))
            before[worker].append(wanted)
        assert model.n_asked == drawn
    assert len(set(before[1])) > 1, "each wanted as many as the others"


def test_what_a_model_raises_is_raised_and_the_floor_runs_again(shop):
    model = Own()
    model.most = 2
    machine = Machine(with_model(shop, model))
    for _ in range(2):
        with pytest.raises(RuntimeError, match="no more"):
            machine.run(0)
    model.n_asked = -1000
    assert len(machine.run(0)) > 1000
