"""The estimate of work is made of visits, which a run counts."""

import numpy as np
import pytest
from plans import line, plan, queue

from opsim.engine.choice import simpy_s, visits
from opsim.engine.floor import run_plan
from opsim.log import WORK


def counted(made):
    return int(np.sum(run_plan(made).columns["kind"] == WORK))


def test_what_comes_by_itself_makes_as_many_visits_as_a_run_counts():
    made = plan(queue(horizon="3 h", every="10 s"))
    assert visits(made) == pytest.approx(counted(made), rel=0.15)


def test_no_more_than_the_bottleneck_lets_through():
    crowded = plan(queue(horizon="3 h", every="0.1 s", mean="10 s"))
    assert visits(crowded) == pytest.approx(1080, rel=0.01)


def test_a_line_that_is_never_idle_makes_about_as_many_as_its_bottleneck():
    made = plan(line(3, 5, horizon="1 h", mean="5 s"))
    assert counted(made) <= visits(made) <= 2 * counted(made)


def test_twice_the_time_is_twice_the_work():
    one, two = (plan(queue(horizon=of)) for of in ("1 h", "2 h"))
    assert simpy_s(two) == pytest.approx(2 * simpy_s(one)) and simpy_s(one) > 0
