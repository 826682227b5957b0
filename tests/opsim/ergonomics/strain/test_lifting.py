"""Lifting indices of a run."""

from dataclasses import replace

import numpy as np
import pytest

from opsim.ergonomics.strain.lifting import Lifts, composite_of, indices, too_often
from opsim.ergonomics.strain.niosh import Lift, composite, lifting_index
from opsim.plan.calendar import Duty
from tests.opsim.ergonomics.made_work import BEND, COUNT
from tests.opsim.ergonomics.strain.test_lifts import loaded_plan


def made_lifts(n=15, every_s=60.0, task=BEND, worker=0, taken=(0.3, 0.4, 0.0), let_go=(0.8, 0.4, 0.0), start_s=0.0):
    """n lifts at even times: height, level distance, asymmetry at both ends."""
    begins = start_s + np.arange(n) * every_s
    ends = (np.tile([one, other], (n, 1)) for one, other in zip(taken, let_go))
    ranks = (np.full(n, rank) for rank in (worker, task))
    return Lifts(*ranks, begins, begins + 3.0, *ends, np.zeros((n, 2)))


def on_shift(plan, *ends_s, horizon_s=None):
    """Everybody's shifts, one after the other from 0 on; the run ends with the last of them, or before."""
    spans = list(zip((0.0, *ends_s), ends_s))
    horizon_s = ends_s[-1] if horizon_s is None else horizon_s
    duties = tuple(
        Duty(low, min(high, horizon_s), 0, at, cut=high > horizon_s, whole_s=(low, high))
        for at, (low, high) in enumerate(spans)
    )
    workers = tuple(replace(one, duties=duties) for one in plan.workers)
    return replace(plan, workers=workers, horizon_s=horizon_s)


def both(one, other):
    return Lifts(*(np.concatenate([getattr(one, name), getattr(other, name)]) for name in Lifts.__slots__))


def test_an_index_is_that_of_the_equation_at_its_worker_s_frequency():
    """61 lifts, one a minute, 60 min and 3 s of lifting: 61 / 60.05 a minute, more than 1 h: the column of 2 h."""
    found = indices(made_lifts(61), on_shift(loaded_plan(), 3603.0))
    per_min = 61 / (3603 / 60)
    taken = lifting_index(Lift(10.0, 40.0, 30.0, 50.0, 0.0, per_min, 2, "good"))
    put = lifting_index(Lift(10.0, 40.0, 80.0, 50.0, 0.0, per_min, 2, "good"))
    assert found.index[0] == pytest.approx([taken, max(taken, put)])


def test_an_index_does_not_depend_on_how_much_of_a_shift_was_simulated():
    """A lift a minute, of 8 h 40, 100 and 200 min are seen: the column of 8 h each time."""
    found = [
        indices(made_lifts(n), on_shift(loaded_plan(), 28800.0, horizon_s=60.0 * n)).index[0] for n in (40, 100, 200)
    ]
    assert found[0] == pytest.approx(found[1], rel=0.01) and found[1] == pytest.approx(found[2], rel=0.01)
    taken = lifting_index(Lift(10.0, 40.0, 30.0, 50.0, 0.0, 200 / (199 + 0.05), 8, "good"))
    assert found[2][0] == pytest.approx(taken)


def test_who_has_no_shifts_lifts_at_most_all_day():
    found = indices(made_lifts(40), loaded_plan()).index[0]
    short, long = (
        indices(made_lifts(40), on_shift(loaded_plan(), at, horizon_s=2400.0)).index[0] for at in (2400.0, 28800.0)
    )
    assert found.tolist() == [short[0], long[1]] and found[0] < found[1]


def test_what_is_lifted_sitting_has_no_index_and_is_left_out_of_the_composite():
    plan = loaded_plan()
    sits = replace(plan.tasks[BEND], handling=replace(plan.tasks[BEND].handling, sitting=True))
    plan = replace(plan, tasks=(sits, *plan.tasks[1:]))
    seated = indices(made_lifts(), plan)
    assert np.isnan(seated.index).all() and seated.out_of_range.all()
    assert np.isnan(composite_of(made_lifts(), seated, plan)).all()
    tasks = list(plan.tasks)
    tasks[COUNT] = replace(tasks[COUNT], handling=loaded_plan().tasks[BEND].handling)
    plan = replace(plan, tasks=tuple(tasks))
    standing, lifts = made_lifts(task=COUNT), both(made_lifts(), made_lifts(task=COUNT))
    alone, among = (composite_of(one, indices(one, plan), plan) for one in (standing, lifts))
    assert among == alone and alone[0] > 0


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
    assert composite_of(lifts, indices(lifts, plan), plan)[0] == pytest.approx(composite(kinds).index)


def test_nobody_who_lifts_nothing_has_an_index():
    none = made_lifts(0)
    assert composite_of(none, indices(none, loaded_plan()), loaded_plan()) == (0.0, 0.0)
    assert not too_often(none, loaded_plan())


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
