"""Times that learning and shifts do not give are found; those of the engine, in pieces or handed over, are right."""

from dataclasses import replace

import numpy as np
import pytest
from human_plans import LINE, planned, shipped, without_effects

from opsim.engine.floor import run_plan
from opsim.human.catalogue import made
from opsim.laws import audit
from opsim.laws.effects import pace
from opsim.laws.jobs import Stays
from opsim.log import WORK, EventLog

ALL = """
human:
  learning: {model: de_jong, rate: 0.8, measured_at: 20}
  forgetting: {model: lfcm, forgotten_in: 20 d, least_pause: 90 s}
  state_pace: {model: schultz, faster: 0.2, slower: 0.1}
  circadian: {amplitude: 0.1}
"""
FLOORS = [
    *(("torque_guns", 3.0), ("relief_worker", 4.0), ("two_shift_plant", 7.0), ("bucket_brigade", 0.5)),
    *(("colour_changes", 8.0), ("moving_line", 1.0), ("paced_line", 1.0), ("skill_chain", 2.0)),
]


def complaints(log, plan):
    return list(pace(log, plan, Stays(log)))


@pytest.mark.parametrize(("name", "hours"), FLOORS)
def test_every_time_is_its_draw_times_what_the_effects_make_of_it(name, hours):
    plan = shipped(name, hours, ALL)
    log = run_plan(plan)
    assert np.unique(log["pace_shift"][log["kind"] == WORK]).size > 10
    audit(log, plan)


def changed(log, column, row, by):
    columns = dict(log.columns)
    columns[column] = columns[column].copy()
    columns[column][row] += by
    return EventLog(log.replication, log.horizon_s, columns, log.names)


@pytest.mark.parametrize(("column", "by"), [("pace_shift", 1e-3), ("start_s", 0.01), ("k", 64)])
def test_a_time_that_does_not_follow_is_found(column, by):
    plan = planned(LINE, ALL)
    log = run_plan(plan)
    row = np.flatnonzero(log["kind"] == WORK)[20]
    assert complaints(log, plan) == []
    (complaint,) = complaints(changed(log, column, row, by), plan)
    assert "its draw, learning and shift give" in complaint


def test_another_rate_of_learning_is_found():
    plan = planned(LINE, ALL)
    other = replace(plan, human=replace(plan.human, learning=made("learning", "de_jong", {"rate": 0.9})))
    assert complaints(run_plan(plan), other) != []


def test_nothing_is_asked_where_nothing_acts_on_times():
    plan = planned(LINE, ALL)
    assert complaints(run_plan(plan), without_effects(plan)) == []
