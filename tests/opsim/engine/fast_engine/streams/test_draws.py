"""Every stream of every shipped scenario against the SimPy engine's, to the bit.

Numbers that are kept whole: all of them, in their order, without copying all at each step.

What numba keeps are tables of these ziggurats: held against the densities.
"""

from dataclasses import replace
from itertools import islice
from threading import Thread

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.engine.draws import Draws
from opsim.engine.fast_engine.streams import generators, of_plan
from opsim.engine.fast_engine.streams.of_plan import BlockDraws, Whole
from opsim.engine.fast_engine.streams.seeds import product_high
from opsim.plan import compile_plan
from opsim.scenario.read import read_scenarios
from opsim.shipped import shipped_folder
from opsim.streams import BLOCK
from opsim.subjects.breakdowns.plan import BreakdownPlan
from opsim.subjects.release.plan import ANY, OrderPlan
from opsim.subjects.tools.plan import HoldPlan, Moment
from opsim.tasks import TimePerformances

N = 3
ITEMS = N * BLOCK
SCENARIOS = sorted(file.stem for file in shipped_folder().glob("*.yaml"))
LONG = ("emptying_pallet", "rack_levels")
"""Each draws movements to many heights; ``shelf_heights`` does so, too."""


def planned(name, variants=None):
    loaded = read_scenarios(shipped_folder() / f"{name}.yaml")
    return [compile_plan(one) for one in islice(loaded.values(), variants)]


def workers_streams(plan, ours, theirs):
    for i, task in enumerate(plan.tasks):
        for j in range(len(plan.workers)):
            yield ours.durations(i, j), theirs.durations(i, j)
            if task.hold is not None:
                yield ours.durations_with(task.hold, i, j), theirs.durations_with(task.hold, i, j)


def stations_streams(plan, ours, theirs):
    for i, task in enumerate(plan.tasks):
        yield ours.automatic_runs(i, 0), theirs.automatic_runs(i, 0)
        if task.hold is not None:
            yield ours.runs_with(task.hold, i, 0), theirs.runs_with(task.hold, i, 0)
    for stop in plan.stops:
        name = tuple(stop.name.split(": ", 1))
        yield ours.repairs(stop), theirs.times(("repair", *name), plan.tasks[stop.task].model)
        if isinstance(stop, BreakdownPlan):
            yield ours.uptimes(stop), theirs.times(("uptime", *name), stop.every)


def sources_streams(plan, ours, theirs):
    for i, _ in enumerate(plan.sources):
        yield ours.gaps(i), theirs.gaps(i)
        rank = theirs.products(i)
        yield ours.products(i), map(rank, range(ITEMS))
        yield ours.ways("fold", 2, i), (theirs.way("fold", 2, i, n) for n in range(ITEMS))


def chances_streams(_plan, ours, theirs):
    for name in (("absence", "ana"), ("yield", "one", "ana"), ("quality", 3)):
        yield ours.chances(name), (theirs.chance(name, n) for n in range(ITEMS))


KINDS = (workers_streams, stations_streams, sources_streams, chances_streams)


def assert_same(plan, replication, kinds=KINDS):
    n_streams = 0
    for kind in kinds:
        for mine, wanted in kind(plan, BlockDraws(plan, replication), Draws(plan, replication)):
            filled = mine.fill(0, N)
            found = np.stack(filled, axis=1) if isinstance(filled, tuple) else filled
            assert found.tobytes() == np.array(list(islice(wanted, ITEMS))).tobytes(), kind
            n_streams += 1
    return n_streams


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in LONG else name for name in SCENARIOS]
)
def test_all_streams_of_a_shipped_scenario_are_the_engines(name):
    (plan,) = planned(name, 1)
    assert assert_same(plan, 3) >= 5


@pytest.mark.parametrize("seed", [2**128 + 1, 2**200])
def test_long_seeds_and_replications_and_redrawn_people_are_the_engines(seed):
    (plan,) = planned("press_shop", 1)
    plan = replace(plan, seed=seed, staffing="redrawn")
    assert assert_same(plan, 2**40) and assert_same(plan, 2**40 + 1)


def test_people_who_are_redrawn_differ_and_others_are_the_same_in_every_replication():
    (plan,) = planned("staffing_luck", 1)
    fixed, redrawn = replace(plan, staffing="fixed"), replace(plan, staffing="redrawn")
    luck = of_plan.luck_of(fixed)
    assert luck.of_worker(0, 0, 0) is luck.of_worker(0, 0, 0)
    assert of_plan.luck_of(redrawn).of_worker(0, 0, 1) is not of_plan.luck_of(redrawn).of_worker(0, 0, 1)
    for made in (fixed, redrawn):
        assert_same(made, 5, (workers_streams,))


class Counting:
    """A plug-in's model whose effect remembers: what one replication does to it must not reach the next."""

    def draw_worker(self, rng, body=None):
        return []

    def sample(self, n, rng, *, worker=None, condition=None):
        worker.append(n)
        return TimePerformances(rng.random(n) + len(worker))


def test_the_effects_of_a_plug_in_are_drawn_anew_in_every_replication():
    (plan,) = planned("serial_line", 1)
    plan = replace(plan, tasks=(replace(plan.tasks[0], model=Counting()), *plan.tasks[1:]))
    hold = HoldPlan(0, Moment(share=0.1), Moment(share=0.2))
    for replication in (0, 1):
        ours, theirs = BlockDraws(plan, replication), Draws(plan, replication)
        wanted = np.array(list(islice(theirs.durations(0, 0), 2 * BLOCK)))
        assert ours.durations(0, 0).fill(0, 2).tobytes() == wanted.tobytes()
        assert ours.durations_with(hold, 0, 0).fill(0, 2)[0].tobytes() == wanted.tobytes()


def test_a_schedule_and_a_sequence_give_the_ranks_of_the_engine():
    (plan,) = planned("queue", 1)
    source = plan.sources[0]
    orders = tuple(OrderPlan(float(i), first, 3, i % 3) for i, first in enumerate((0, 3, 10, 11, 100)))
    mixed = tuple(replace(order, product=ANY) for order in orders)
    mix = ((2, 0.1), (3, 0.6), (5, 0.3))
    for changed in ({"orders": orders}, {"orders": mixed}, {"sequence": (4, 4, 1)}, {}):
        made = replace(plan, sources=(replace(source, mix=mix, **changed),))
        ranks, rank = BlockDraws(made, 2).products(0).fill(1, 3), Draws(made, 2).products(0)
        assert ranks.dtype == np.int64 and ranks.tolist() == [rank(n) for n in range(BLOCK, 4 * BLOCK)]


def test_the_luck_of_a_plan_is_found_once_and_of_few_plans_kept():
    plans = [replace(planned("queue", 1)[0], seed=seed) for seed in range(6)]
    first = of_plan.luck_of(plans[0])
    assert of_plan.luck_of(plans[0]) is first
    for plan in plans:
        assert of_plan.luck_of(plan).plan is plan
    assert len(of_plan._last) <= 4 and of_plan.luck_of(plans[0]) is not first


def test_blocks_come_in_any_order_and_any_number():
    (plan,) = planned("serial_line", 1)
    stream = BlockDraws(plan, 1).durations(0, 0)
    whole = stream.fill(0, 16)
    for first, n in ((15, 1), (0, 1), (1, 2), (3, 4), (7, 8), (0, 16)):
        assert stream.fill(first, n).tobytes() == whole[first * BLOCK : (first + n) * BLOCK].tobytes()


def test_two_threads_that_draw_at_once_draw_what_one_draws():
    (plan,) = planned("serial_line", 1)
    alone = [BlockDraws(plan, r).durations(0, 0).fill(0, 40).tobytes() for r in range(30)]
    found = {}

    def draw(thread):
        found[thread] = [BlockDraws(plan, r).durations(0, 0).fill(0, 40).tobytes() for r in range(30)]

    threads = [Thread(target=draw, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == {0: alone, 1: alone}


GROWTHS, AT_ONCE = 300, 64


def test_all_numbers_are_there_in_their_order():
    whole = Whole()
    for i in range(GROWTHS):
        whole.add(np.arange(i * AT_ONCE, (i + 1) * AT_ONCE, dtype=float))
        assert whole.n == (i + 1) * AT_ONCE
        assert np.array_equal(whole.numbers, np.arange(whole.n))


def test_all_that_was_ever_given_takes_little_more_than_the_last():
    whole, given = Whole(), {}
    for _ in range(GROWTHS):
        whole.add(np.ones(AT_ONCE))
        given[id(whole.numbers.base)] = whole.numbers.base
    assert sum(room.nbytes for room in given.values()) < 4 * whole.numbers.nbytes


def test_what_was_given_before_stays_as_it_was():
    whole = Whole()
    whole.add(np.zeros(AT_ONCE))
    before = whole.numbers
    for _ in range(GROWTHS):
        whole.add(np.ones(AT_ONCE))
    assert not before.any()


WORD = st.integers(0, 2**64 - 1)


@numba.njit
def upper_half(one, other):
    return product_high(one, other)


@given(WORD, WORD)
def test_the_upper_half_is_that_of_whole_numbers_of_any_length(one, other):
    assert upper_half(np.uint64(one), np.uint64(other)) == one * other >> 64


@pytest.mark.parametrize(
    ("table", "density", "bits"),
    [
        (generators.exponential(), lambda x: np.exp(-x), 53),
        (generators.normal(), lambda x: np.exp(-(x**2) / 2), 52),
    ],
    ids=["exponential", "normal"],
)
def test_widths_densities_and_bounds_go_together(table, density, bits):
    edges = table.w * 2.0**bits
    assert np.allclose(table.f[1:], density(edges[1:]), rtol=1e-12) and table.f[0] == 1.0
    inner = edges[1:-1] / edges[2:]
    assert np.allclose(table.k[2:] / 2.0**bits, inner, rtol=1e-12) and table.k[1] == 0
