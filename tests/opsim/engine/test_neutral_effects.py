"""Off means off: every effect at its neutral values, through its own code, leaves the event log as it was."""

import pytest
from checked_floors import differ
from human_plans import NEUTRAL, shipped, without_effects

from opsim.engine.floor import run_plan
from opsim.human.catalogue import entry

FLOORS = [
    *(("serial_line", 4.0), ("cherry_picking", 2.0)),  # a line, a pool
    *(("two_shift_plant", 7.0), ("night_shift", 8.0), ("relief_worker", 4.0)),  # breaks, closing, interruption
    *(("torque_guns", 2.0), ("bucket_brigade", 1.0), ("u_cell", 1.0)),  # tools held between moments, teams, crews
    *(("colour_changes", 4.0), ("paced_line", 2.0), ("moving_line", 1.0)),  # set-ups, andon, a moving line
    pytest.param("repack_cell", 1.0, marks=pytest.mark.slow),  # recorded movements: a library is read
]


@pytest.mark.parametrize(("name", "hours"), FLOORS)
def test_neutral_effects_change_no_bit_of_a_log(name, hours):
    plan = shipped(name, hours, NEUTRAL)
    assert plan.human.changes_times and plan.human.learning == entry("learning").cls(rate=1.0, measured_at=7.0)
    assert differ(run_plan(plan), run_plan(shipped(name, hours))) == []


@pytest.mark.parametrize(
    "human",
    [
        *(f"human: {{learning: {{model: {model}}}}}" for model in ("wright", "de_jong")),
        "human: {state_pace: {model: schultz}}",
        "human: {circadian: {amplitude: 0.1}}",
    ],
)
def test_the_same_comparison_sees_effects_that_are_not_neutral(human):
    plan = shipped("serial_line", 2.0, human)
    assert differ(run_plan(plan), run_plan(without_effects(plan))) != []
