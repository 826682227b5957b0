"""Rules by exposure on both engines; the rates are Python's, as everybody has them."""

import numpy as np
import pytest
from made_pool import POOL
from twins import of_both, twins

from opsim.engine.fast_engine import run_plan
from opsim.ergonomics.shift.dose_rates import DoseRates
from opsim.log import FINISH, WORK

UNEVEN = POOL.replace("cem: {skills: {a: 1, b: 1}}", "cem: {skills: {a: 1, b: 0.7}}").replace(
    "tasks: [heavy], buffer: 5",
    "tasks: [heavy], buffer: 5, breakdowns: {jam: {every: {dist: exponential, mean: 4 min}, repair: {fixed: 60 s}}}",
)
"""Cem is slow at light work, and heavy work breaks off again and again."""
TURN = (
    "allocation: {rule: least_exposed}",
    "rotations: {turn: {workers: [cem, ana, ben], posts: [b, [], a], every: 5 min, rule: least_exposed}}",
)
TIRED = ("allocation:", "human: {fatigue: {model: lffrm, tires_half_in: 20 min}}\nallocation:")


@pytest.fixture
def known(monkeypatch):
    """How fast heavy and light work add to a dose; ben gathers it faster."""
    monkeypatch.setattr(DoseRates, "per_s", lambda self, worker, task: (6.0, 2.0, 1.0)[task] + 0.1 * (worker == 1))


@pytest.mark.parametrize("edits", [(), (TURN,), (TIRED,), (TIRED, TURN)])
def test_work_goes_to_the_least_exposed_as_in_the_reference(known, edits):
    log = twins(UNEVEN, *edits)
    work = log.of(WORK)
    assert len(log.of(FINISH)) > 100 and (work["progress_to"] < 1.0).any()
    assert bool(work["pace_shift"].any()) == (TIRED in edits)


def test_where_nobody_knows_a_posture_all_doses_are_0():
    log = twins(UNEVEN)
    assert np.array_equal(log["worker"], twins(UNEVEN, ("least_exposed", "longest_queue"))["worker"])


def test_what_python_raises_when_it_is_asked_is_raised_by_the_run(monkeypatch):
    from plans import plan

    def fails(*_args):
        raise RuntimeError("no such posture")

    monkeypatch.setattr(DoseRates, "per_s", fails)
    for text in (UNEVEN, UNEVEN.replace(*TURN)):
        with pytest.raises(RuntimeError, match="no such posture"):
            run_plan(plan(text))


def test_a_shipped_cell_of_bodies_is_the_same():
    from human_plans import shipped

    of_both(shipped("least_exposed", 0.5))
