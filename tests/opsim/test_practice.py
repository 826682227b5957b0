from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from human_plans import LINE, planned, shipped, without_effects

from opsim.engine.floor.run import run_plan
from opsim.history import own_rows, practice

FORGETFUL = """
human:
  learning: {model: wright, rate: 0.8}
  forgetting: {model: lfcm, forgotten_in: 20 d, least_pause: 30 s}
"""
MANY = [
    pytest.param("torque_guns", 0.2, marks=pytest.mark.slow),
    ("relief_worker", 1.0),
    ("bucket_brigade", 0.5),
    ("colour_changes", 8.0),
]


def test_repetitions_are_counted_by_worker_and_task_from_his_experience_on():
    plan = planned(LINE.replace("{a: 1.0}", "{a: 1.0}, experience: {cut: 50}"), "human: {learning: {model: wright}}")
    log = run_plan(plan)
    found = practice(log, plan)
    ana = found.row[log["worker"][found.row] == 0]
    assert found.repetition[: ana.size].tolist() == [51.0 + k for k in range(ana.size)]
    assert found.multiplier[0] == plan.human.learning.multiplier(51.0)


class Spy:
    """Learning of nothing, which keeps what it was asked."""

    def __init__(self):
        self.asked = []

    def multiplier(self, n):
        self.asked.append(n)
        return 1.0

    def work(self, n):
        return n


@pytest.mark.parametrize(("name", "hours"), MANY)
def test_the_repetitions_read_from_the_rows_are_those_of_the_run(name, hours):
    spy, plan = Spy(), shipped(name, hours, FORGETFUL)
    plan = replace(plan, human=replace(plan.human, learning=spy))
    log = run_plan(plan)
    asked = sorted(spy.asked)
    found = practice(log, plan)
    _, first = np.unique(log["performance_id"][found.row], return_index=True)
    assert np.any(found.repetition != np.rint(found.repetition)), "somebody forgot something"
    of_means = len(asked) - first.size  # the first repetition of a task, whose mean time forgetting asks for
    again = Counter(asked) - Counter(found.repetition[first].tolist())  # who waits for a tool is asked once more
    assert of_means >= 0 and again.total() == of_means
    assert name == "torque_guns" or (of_means <= len(plan.tasks) and set(again) <= {1.0})


def test_without_effects_every_multiplier_is_one():
    plan = without_effects(planned(LINE))
    assert np.all(practice(run_plan(plan), plan).multiplier == 1.0)


def test_rows_come_by_worker_and_start():
    plan = planned(LINE)
    log = run_plan(plan)
    rows = own_rows(log, plan)
    assert rows.tolist() == sorted(rows.tolist(), key=lambda row: (log["worker"][row], log["start_s"][row]))
