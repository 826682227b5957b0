"""What the shipped scenario on learning shows: a weekend costs some of the first week, and who is new costs output."""

from functools import cache

import numpy as np
import pytest

from opsim.engine.floor.run import run_plan
from opsim.history import practice
from opsim.log import FINISH
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios

DAY_S = 86_400.0


@cache
def plans():
    return {name: compile_plan(loaded) for name, loaded in read_scenarios("learning_curve").items()}


def finished(variant, replication):
    return int(np.count_nonzero(run_plan(plans()[variant], replication)["kind"] == FINISH))


def multipliers_of_ada(variant):
    """Her multiplier of time at the beginning, at the end of the first week and at the beginning of the second."""
    plan = plans()[variant]
    log = run_plan(plan)
    found = practice(log, plan)
    mine = log["worker"][found.row] == 0
    start_s, multiplier = log["start_s"][found.row[mine]], found.multiplier[mine]
    return multiplier[0], multiplier[start_s < 5 * DAY_S][-1], multiplier[start_s > 7 * DAY_S][0]


def test_the_first_repetition_takes_2_24_times_as_long_as_recorded():
    """De Jong, M 0.25, rate 0.85: 300^-0.23447 = 0.26255; 1 / (0.25 + 0.75 * 0.26255) = 2.2376."""
    assert multipliers_of_ada("new_people")[0] == pytest.approx(2.2376, abs=1e-4)


def test_a_weekend_takes_back_some_of_the_week_but_not_all():
    first, friday, monday = multipliers_of_ada("new_people")
    assert friday < monday < first
    first, friday, monday = multipliers_of_ada("no_forgetting")
    assert monday < friday < first


@pytest.mark.parametrize("replication", range(3))
def test_experience_is_output_and_forgetting_costs_some(replication):
    new, kept, one, old = (
        finished(variant, replication) for variant in ("new_people", "no_forgetting", "one_new", "experienced")
    )
    assert new < kept < old and new < one <= old
