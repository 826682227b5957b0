"""A task model of somebody's own, put into a plan by hand, that draws what no time is: said, in both engines."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from plans import plan

from opsim.engine import fast_engine
from opsim.engine.floor.run import run_plan

LINE = """
opsim: 1
name: one bench
run: {horizon: 1 h, seed: 1}
layout: {places: {here: [0 m, 0 m]}}
tasks: {sit: {fixed: 10 s}}
stations: {bench: {at: here, tasks: [sit], buffer: 1}}
products: {part: {route: [bench]}}
release: {kind: saturated}
workers: {ana: {skills: {bench: 1}}}
"""


class Wrong:
    """Draws good times but for one."""

    def __init__(self, time_s, by_index=False):
        self._time_s, self.by_index = time_s, by_index

    def mean_duration_s(self, worker=None):
        return 10.0

    def draw_worker(self, rng, body=None, **more):
        return None

    def at(self, items):
        return np.where(np.asarray(items) == 3, self._time_s, 10.0)

    def sample(self, n, rng, *, worker=None, condition=None):
        return SimpleNamespace(duration_s=self.at(np.arange(n)), mark_s=np.zeros((n, 0)))


@pytest.mark.parametrize("run", [run_plan, fast_engine.run_plan], ids=["simpy", "fast"])
@pytest.mark.parametrize("by_index", [False, True])
@pytest.mark.parametrize(("time_s", "said"), [(-3.0, "-3 s"), (float("nan"), "nan s"), (float("inf"), "inf s")])
def test_a_time_that_is_none_is_refused_and_not_run(run, by_index, time_s, said):
    made = plan(LINE)
    wrong = replace(made, tasks=tuple(replace(task, model=Wrong(time_s, by_index)) for task in made.tasks))
    with pytest.raises(ValueError, match=f"Wrong drew a time of {said}, expected a number of seconds"):
        run(wrong)
