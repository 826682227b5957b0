"""Rules by exposure: the dose that the engine counts, and how nearly even it comes out."""

from types import SimpleNamespace

import numpy as np
import plans
import pytest
import simpy
from checked_floors import differ
from made.pool import POOL

from opsim.engine.floor.run import FloorOfPlan, run_plan, run_until
from opsim.ergonomics.shift.worst import DoseRates
from opsim.log import FINISH, SETUP, WORK
from opsim.scenario import read_scenarios
from opsim.subjects.human.human_effects import stops, works
from opsim.subjects.human.human_state import Dose, dose_so_far

TURN = (
    "allocation: {rule: least_exposed}",
    "rotations: {turn: {workers: [ana, ben, cem], posts: [a, b, []], every: 5 min}}",
)
HEAVY, LIGHT = 6.0, 2.0


@pytest.fixture
def known(monkeypatch):
    """RULA 6 a second of heavy work and 2 of light work, of everybody."""
    monkeypatch.setattr(DoseRates, "per_s", lambda self, _worker, task: (HEAVY, LIGHT)[task])


def ran(*edits):
    """The log, which obeys all laws, and its plan."""
    return plans.ran(POOL, *edits)


def doses(log, plan, per_s=lambda _worker, task: (HEAVY, LIGHT)[task]):
    """RULA x seconds of each worker: the sum over his rows of work."""
    found = np.zeros(len(plan.workers))
    for row in np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0)):
        worker, task = int(log["worker"][row]), int(log["task"][row])
        found[worker] += per_s(worker, task) * (log["end_s"][row] - log["start_s"][row])
    return found


def test_a_dose_grows_with_work_and_stands_still_without(known):
    """6 a second from 0 to 4, broken off: 24; 2 a second from 10 to 12: 26 at 11 s, 28 from 12 s on."""
    rates, dose = DoseRates(None, 0), Dose()
    dose.rates = [np.nan, np.nan]
    dose.ask_rate = lambda worker, task: dose.rates.__setitem__(task, rates.per_s(worker, task))
    effects = SimpleNamespace(pass_line=None, forgets=0, rests=0)
    worker = SimpleNamespace(rank=0, dose=dose, human=SimpleNamespace(effects=effects))

    def at(now, **asked):
        return SimpleNamespace(now=now, asked_done=0.0, asked_k=0, **asked)

    works(at(0.0, asked_task=0, asked_until_s=10.0), worker)
    assert dose_so_far(at(3.0), worker) == 18.0
    stops(at(4.0), worker)
    assert dose_so_far(at(9.0), worker) == 24.0
    works(at(10.0, asked_task=1, asked_until_s=12.0), worker)
    assert [dose_so_far(at(now), worker) for now in (10.0, 11.0, 12.0, 99.0)] == [24.0, 26.0, 28.0, 28.0]


FLOORS = [
    *(("two_shift_plant", 2), ("night_shift", 10), ("relief_worker", 4)),  # breaks, closing, who steps in
    *(("torque_guns", 1), ("u_cell", 1), ("moving_line", 1), ("press_shop", 2)),  # tools, crews, andon, set-ups
]


@pytest.mark.parametrize(("name", "hours"), FLOORS)
def test_the_doses_that_are_counted_are_those_of_the_rows(name, hours, monkeypatch):
    """Whatever breaks work off, hands it over, or lets several do it."""
    monkeypatch.setattr(DoseRates, "per_s", lambda self, worker, task: odd(worker, task))
    changes = {"allocation.rule": "least_exposed", "run.horizon": f"{hours} h", "run.warm_up": "0 s"}
    plan = plans.compile_plan(next(iter(read_scenarios(name, None, changes).values())))
    one, env = FloorOfPlan(plan), simpy.Environment()
    one.open(env)
    run_until(env, plan.horizon_s)
    log = one.close()
    counted = [dose_so_far(one.floor, worker) for worker in one.build.workers]
    assert np.allclose(counted, doses(log, plan, odd), rtol=1e-9, atol=1e-6)
    assert max(counted) > 1000


def odd(worker, task):
    return 1.0 + (7 * task + 3 * worker) % 5


def test_alike_people_end_within_two_performances_of_each_other(known):
    """The longest heavy performance is of 70 to 100 s: of doses of some 11,000 the worst differ by less than 1,200."""
    log, plan = ran()
    longest = HEAVY * max(log["end_s"][log["kind"] == WORK] - log["start_s"][log["kind"] == WORK])
    even, uneven = doses(log, plan), doses(*ran(("rule: least_exposed", "rule: oldest_job")))
    assert np.ptp(even) <= 2 * longest
    assert np.ptp(uneven) > 2 * np.ptp(even)


def test_the_heavy_post_is_shared_by_those_who_can_lift(known):
    """Cem cannot: by turns it is always Ben who goes for him, and has half as much again as Ana."""
    no_lift = ("cem: {skills: {a: 1, b: 1}}", "cem: {skills: {b: 1}}")
    gap = {}
    for rule in ("in_turn", "least_exposed"):
        words = TURN[1].replace("[a, b, []]", "[a, b, b]").replace("5 min", f"5 min, rule: {rule}")
        ana, ben, _ = doses(*ran(no_lift, (TURN[0], words)))
        gap[rule] = abs(ana - ben)
    assert gap["least_exposed"] < HEAVY * 300 < gap["in_turn"] / 2  # what five minutes at the heavy post add at most


def test_as_much_comes_out_where_everybody_is_as_fast(known):
    fixed = [
        ("dist: lognormal, mean: 30 s, cv: 0.4", "fixed: 30 s"),
        ("dist: lognormal, mean: 20 s, cv: 0.4", "fixed: 20 s"),
    ]
    logs = [ran(*fixed, ("rule: least_exposed", f"rule: {rule}"))[0] for rule in ("least_exposed", "oldest_job")]
    one, other = (np.sort(log["end_s"][log["kind"] == FINISH]) for log in logs)
    assert np.array_equal(one, other) and len(one) > 150


def test_where_nobody_knows_a_posture_the_rules_are_those_they_stand_on():
    """Times without bodies add no dose: the oldest call, and everybody in turn."""
    assert differ(ran()[0], ran(("rule: least_exposed", "rule: oldest_job"))[0]) == []
    by_dose = (TURN[0], TURN[1].replace("every: 5 min", "every: 5 min, rule: least_exposed"))
    assert differ(ran(by_dose)[0], ran(TURN)[0]) == []


def test_the_order_in_the_file_decides_nothing(known):
    shuffled = [
        ("  ana: {skills: {a: 1, b: 1}}\n", ""),
        ("  cem: {skills: {a: 1, b: 1}}\n", "  cem: {skills: {b: 1, a: 1}}\n  ana: {skills: {a: 1, b: 1}}\n"),
    ]
    assert differ(ran()[0], ran(*shuffled)[0]) == []


def test_nothing_is_counted_where_no_rule_asks(monkeypatch):
    monkeypatch.setattr(DoseRates, "per_s", lambda *_: pytest.fail("nobody asked"))
    ran(("rule: least_exposed", "rule: nearest"))


@pytest.mark.slow
def test_the_shipped_scenario_evens_out_what_turns_leave_uneven():
    """Of two hours, on real movements: the widest gap of doses is less than half of that in turn."""
    found = {}
    for name, loaded in read_scenarios("least_exposed", ["in_turn", "least_exposed"], {"run.horizon": "4 h"}).items():
        plan = plans.compile_plan(loaded)
        log = run_plan(plan)
        found[name] = np.ptp(doses(log, plan, DoseRates(plan, 0).per_s)), (log["kind"] == FINISH).sum()
    assert found["least_exposed"][0] < 0.5 * found["in_turn"][0]
    assert abs(found["least_exposed"][1] - found["in_turn"][1]) <= 2
