"""The rules of the floor as CPython reads them, on a SimPy environment."""

import inspect
from dataclasses import replace

import numpy as np
import pytest
import simpy
from checked_floors import plan_of
from engine_evidence.floors import floor_text, replication_of
from stand_in_engine import install_rule

from opsim.engine.difference import difference
from opsim.engine.floor.run import FloorOfPlan, run_plan
from opsim.log import WORK
from opsim.plan import Plan, compile_plan
from opsim.scenario import read_scenarios
from opsim.subjects.human.fatigue import Lffrm, Schultz
from opsim.subjects.people import allocation


def shipped(name: str, **changes: str) -> Plan:
    changes = {"run.horizon": "2 h", "run.warm_up": "0 s", **changes}
    return compile_plan(next(iter(read_scenarios(name, None, changes).values())))


@pytest.mark.parametrize("number", range(0, 60, 5))
def test_rows_are_the_same_with_a_process_for_each_worker(number):
    plan, replication = plan_of(floor_text(number)), replication_of(number)
    assert difference(run_plan(plan, replication), run_plan(plan, replication, processes=True)) is None


def test_a_floor_that_was_used_before_is_as_good_as_a_new_one():
    plan = shipped("two_shift_plant")
    first = run_plan(plan, 0)
    run_plan(plan, 1)
    assert difference(first, run_plan(plan, 0)) is None
    assert difference(first, run_plan(replace(plan), 0)) is None  # another object: set up anew


def test_workers_are_processes_in_anybodys_environment():
    """The environment is driven as SimPy drives it, and is at its end where the floor's horizon is."""
    plan, env = shipped("serial_line"), simpy.Environment()
    one, seen = FloorOfPlan(plan), []

    def watch(worker):
        while True:
            yield worker.stretch_over
            seen.append((env.now, worker.name))

    one.open(env)
    worker = one.build.workers[0]
    assert isinstance(worker.process, simpy.Process) and worker.process.is_alive
    env.process(watch(worker))
    env.run(until=plan.horizon_s)
    log = one.close()
    assert difference(log, run_plan(plan)) is None
    ends = log.of(WORK)
    mine = ends["end_s"][(ends["worker"] == worker.rank) & (ends["end_s"] < plan.horizon_s)]
    assert set(mine) <= {at for at, name in seen if name == worker.name}


def test_a_rule_that_raises_is_seen_in_the_file_in_which_it_is_written(monkeypatch):
    monkeypatch.setattr(allocation, "_serve_one", lambda floor: 1 / 0)
    with pytest.raises(ZeroDivisionError) as raised:
        run_plan(shipped("serial_line"))
    assert str(inspect.getsourcefile(allocation)) in {str(entry.path) for entry in raised.traceback}


@pytest.mark.parametrize(
    ("group", "path", "ours", "name"),
    [
        ("opsim.dispatch", "allocation.rule", "nearest", "assembly"),
        ("opsim.sequencing", "flow.dispatch", "downstream_first", "press_shop"),
        ("opsim.routing", "flow.routing", "in_order", "press_shop"),
    ],
)
def test_rules_of_others_have_keys_of_any_length(group, path, ours, name, tmp_path, monkeypatch):
    """One number more than ours has, which is always the same: the rows are those of ours."""
    like = f"lambda *n: (*__import__('opsim.engine.rules', fromlist=['x']).{ours}(*n), 1.0)"
    install_rule(tmp_path, monkeypatch, group, "theirs", like)
    logs = [run_plan(shipped(name, **{path: rule})) for rule in (ours, "theirs")]
    assert difference(*logs) is None
    assert difference(logs[0], run_plan(shipped(name))) is not None  # the rule decides something here


class Moody(Lffrm):
    """A fatigue whose state is no number."""

    def fresh(self):
        return {"tired": 0.0}

    def passed(self, state, *what):
        return {"tired": Lffrm.passed(self, state["tired"], *what)}

    def rested(self, state, seconds):
        if not isinstance(state, dict):  # asked by ``Lffrm.passed``
            return Lffrm.rested(self, state, seconds)
        return {"tired": Lffrm.rested(self, state["tired"], seconds)}

    def level(self, state):
        return state["tired"]


class Hasty(Schultz):
    """A pace of somebody else's with the formula of ours."""


def test_human_effects_of_others_are_asked_by_their_own_methods():
    plan = shipped("serial_line")
    ours = replace(plan, human=replace(plan.human, fatigue=Lffrm(), state_pace=Schultz()))
    theirs = replace(plan, human=replace(plan.human, fatigue=Moody(), state_pace=Hasty()))
    one, two = run_plan(ours), run_plan(theirs)
    assert difference(one, two) is None
    assert np.nanmax(np.abs(one["pace_shift"])) > 0
