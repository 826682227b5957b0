"""Lifting indices of a run."""

from dataclasses import replace

import numpy as np
import pytest

from opsim.ergonomics.lifting import composite_of, indices, too_often
from opsim.ergonomics.lifts import Lifts
from opsim.ergonomics.niosh import Lift, lifting_index
from opsim.ergonomics.niosh_composite import composite
from tests.opsim.ergonomics.made_work import BEND, COUNT
from tests.opsim.ergonomics.test_lifts import loaded_plan


def made_lifts(n=15, every_s=60.0, task=BEND, worker=0, taken=(0.3, 0.4, 0.0), let_go=(0.8, 0.4, 0.0), start_s=0.0):
    """n lifts at even times: height, level distance, asymmetry at both ends."""
    begins = start_s + np.arange(n) * every_s
    ends = (np.tile([one, other], (n, 1)) for one, other in zip(taken, let_go))
    ranks = (np.full(n, rank) for rank in (worker, task))
    return Lifts(*ranks, begins, begins + 3.0, *ends, np.zeros((n, 2)))


def both(one, other):
    return Lifts(*(np.concatenate([getattr(one, name), getattr(other, name)]) for name in Lifts.__slots__))


def test_an_index_is_that_of_the_equation_at_its_worker_s_frequency():
    """61 lifts, one a minute, 60 min and 3 s of lifting: 61 / 60.05 a minute, more than 1 h: the column of 2 h."""
    found = indices(made_lifts(61), loaded_plan())
    per_min = 61 / (3603 / 60)
    taken = lifting_index(Lift(10.0, 40.0, 30.0, 50.0, 0.0, per_min, 2, "good"))
    put = lifting_index(Lift(10.0, 40.0, 80.0, 50.0, 0.0, per_min, 2, "good"))
    assert found.index[0] == pytest.approx([taken, max(taken, put)])


def test_what_nobody_said_of_the_grip_is_between_good_and_poor():
    lifts = made_lifts()
    good, poor, unsaid = (indices(lifts, loaded_plan(grip=grip)).index[0] for grip in ("good", "poor", None))
    assert unsaid.tolist() == [good[0], poor[1]] and good[0] < poor[0]


def test_where_it_is_put_down_counts_only_at_most():
    lifts = made_lifts(let_go=(1.5, 0.6, 60.0))
    near = made_lifts(let_go=(1.5, 0.4, 0.0))
    found, other = (indices(one, loaded_plan()).index[0] for one in (lifts, near))
    assert found[0] == other[0] and found[1] > other[1] > other[0]


def test_beyond_the_range_the_edge_stands_and_it_is_told():
    plan = loaded_plan()
    far, edge = (indices(made_lifts(taken=(0.3, h, 0.0)), plan) for h in (0.7, 0.63))
    assert far.out_of_range.all() and not edge.out_of_range.any()
    assert far.index.tolist() == edge.index.tolist()
    often = indices(made_lifts(400, every_s=3.0), plan)
    assert often.out_of_range.all() and np.isfinite(often.index).all()


def test_a_composite_is_that_of_the_equation_over_kinds_of_lifts():
    """Two tasks at a lift a minute each for 59 min; within an hour."""
    plan = loaded_plan()
    tasks = list(plan.tasks)
    tasks[COUNT] = replace(tasks[COUNT], handling=replace(tasks[BEND].handling, load_kg=15.0))
    plan = replace(plan, tasks=tuple(tasks))
    lifts = both(made_lifts(60), made_lifts(60, task=COUNT, start_s=5.0, taken=(0.8, 0.5, 0.0), let_go=(1.1, 0.5, 0.0)))
    per_min = 60 / ((59 * 60 + 8) / 60)
    kinds = [Lift(10.0, 40.0, 30.0, 50.0, 0.0, per_min, 1), Lift(15.0, 50.0, 80.0, 30.0, 0.0, per_min, 1)]
    assert composite_of(lifts, indices(lifts, plan), 0) == pytest.approx(composite(kinds).index)


def test_nobody_who_lifts_nothing_has_an_index():
    none = made_lifts(0)
    assert composite_of(none, indices(none, loaded_plan()), 0) == 0.0 and not too_often(none)


def test_lifts_at_least_are_never_more_than_at_most_and_more_often_is_worse():
    rng, plan = np.random.default_rng(3), loaded_plan(grip=None)
    seldom, often = (made_lifts(40, every_s=every) for every in (120.0, 20.0))
    for lifts in (seldom, often):
        lifts.height_m[:] = rng.uniform(0, 1.9, (40, 2))
        lifts.horizontal_m[:] = rng.uniform(0.2, 0.8, (40, 2))
    found = indices(seldom, plan).index
    assert (found[:, 0] <= found[:, 1]).all()
    same = replace(often, height_m=seldom.height_m, horizontal_m=seldom.horizontal_m)
    assert (indices(same, plan).index >= found - 1e-12).all()
