"""A whole floor in somebody's own SimPy model."""

from dataclasses import replace

import numpy as np
import pytest
import simpy

from opsim import Floor, audit, compile_plan, figures, read_scenarios, run_plan
from opsim.floor import FloorEnded
from opsim.log import CREATE, FINISH, LEAVING_KINDS
from opsim.shipped import shipped_folder

STARTS_S = (0.0, 6 * 3600.0, 12345.678)
ALONE = ("repack_cell", "pump_plant", "torque_guns")
"""A cell with postures; kits, splits, hours and stores; tools that are waited for."""


def shipped(name):
    return compile_plan(next(iter(read_scenarios(shipped_folder() / f"{name}.yaml").values())))


def rows(log):
    return {name: column.tobytes() for name, column in log.columns.items()}


def releases(env, floor, product, every_s, got):
    while True:
        yield env.timeout(every_s)
        got.append((yield floor.release(product)))


@pytest.fixture(scope="module")
def cell():
    return shipped("repack_cell")


@pytest.mark.parametrize(
    ("name", "start_s"),
    [
        *((name, STARTS_S[2]) for name in ALONE),
        *(("torque_guns", start_s) for start_s in STARTS_S[:2]),
        *(pytest.param(name, start_s, marks=pytest.mark.slow) for name in ALONE[:2] for start_s in STARTS_S[:2]),
    ],
)
def test_a_floor_alone_gives_the_rows_of_run_plan(name, start_s):
    plan = shipped(name)
    env = simpy.Environment(initial_time=start_s)
    floor = Floor(env, plan, replication=1)
    env.run()
    assert floor.start_s == start_s and env.now == start_s + plan.horizon_s
    assert rows(floor.log()) == rows(run_plan(plan, 1))


def test_what_leaves_is_seen_at_the_times_of_the_environment(cell):
    env = simpy.Environment(initial_time=1000)
    floor = Floor(env, cell)
    seen = []

    def reads():
        while True:
            left = yield floor.leaving.get()
            seen.append((env.now, left))

    env.process(reads())
    env.run()
    log = floor.log()
    done = log.of(FINISH)
    assert [left.number for _, left in seen] and {left.number for _, left in seen} == set(done["job"].tolist())
    assert sorted(left.at_s for _, left in seen) == (done["end_s"] + 1000).tolist()
    assert all(now_s == left.at_s and left.good and left.what == "finished" for now_s, left in seen)
    created = dict(zip(log.of(CREATE)["job"].tolist(), log.of(CREATE)["end_s"].tolist()))
    assert all(left.created_s == created[left.number] + 1000 for _, left in seen)


def test_two_floors_in_one_environment_leave_each_other_alone(cell):
    other = shipped("torque_guns")
    env = simpy.Environment(initial_time=50)
    first = Floor(env, cell)
    env.run(until=950.25)
    floors = [first, Floor(env, cell), Floor(env, other, 3)]
    env.run()
    assert [floor.start_s for floor in floors] == [50, 950.25, 950.25]
    assert [rows(floor.log()) for floor in floors] == [
        rows(run_plan(cell)),
        rows(run_plan(cell)),
        rows(run_plan(other, 3)),
    ]


def test_a_floor_in_real_time():
    plan = replace(shipped("queue"), horizon_s=1800.0, warm_up_s=0.0)
    env = simpy.RealtimeEnvironment(initial_time=7, factor=1e-5, strict=False)
    floor = Floor(env, plan)
    env.run()
    assert rows(floor.log()) == rows(run_plan(plan))


def test_other_processes_change_nothing(cell):
    env = simpy.Environment()
    floor = Floor(env, cell)

    def ticks():
        while True:
            yield env.timeout(0.5)

    env.process(ticks())
    env.run(until=floor.ended)
    assert rows(floor.ended.value) == rows(run_plan(cell))


@pytest.mark.parametrize("name", [*ALONE, pytest.param("two_shift_plant", marks=pytest.mark.slow), "kanban_cell"])
def test_the_log_may_be_asked_for_at_any_moment(name):
    plan = shipped(name)
    env = simpy.Environment(initial_time=100.3)
    floor = Floor(env, plan)
    for share in (0.0, 0.13, 0.37, 0.77):
        if share:
            env.run(until=100.3 + share * plan.horizon_s)
        log, so_far = floor.log(), floor.plan_so_far()
        assert log.horizon_s == so_far.horizon_s == floor.now_s
        assert not log.duration_s.size or log["end_s"].max() <= floor.now_s
        audit(log, so_far)
    env.run()
    assert floor.plan_so_far() is plan
    assert rows(floor.log()) == rows(run_plan(plan)), "asking changes nothing"


@pytest.mark.parametrize("at_s", [600.0, 4321.5])
def test_the_log_so_far_is_that_of_a_shorter_run(cell, at_s):
    env = simpy.Environment()
    floor = Floor(env, cell)
    env.run(until=at_s)
    shorter = replace(cell, horizon_s=at_s, warm_up_s=0.0)
    assert rows(floor.log()) == rows(run_plan(shorter))
    assert floor.plan_so_far().warm_up_s == (cell.warm_up_s if at_s > cell.warm_up_s else 0.0)
    values = {f.kpi: f.value for f in figures(floor.log(), floor.plan_so_far()) if not f.subject}
    assert values["throughput_per_h"] > 0


def test_a_released_job_ends_its_event_as_it_leaves(cell):
    env = simpy.Environment(initial_time=500.3)
    floor = Floor(env, cell)
    got = []
    env.process(releases(env, floor, "carton", 900.0, got))
    env.run(until=floor.ended)
    log, own = floor.log(), run_plan(cell)
    audit(log, cell)
    assert len(got) > 20 and {left.product for left in got} == {"carton"}
    ours = log.where(np.isin(log["job"], [left.number for left in got]))
    gone, came = ours.of(*LEAVING_KINDS), ours.of(CREATE)
    assert np.allclose(sorted(left.at_s for left in got), np.sort(gone["end_s"]) + 500.3, rtol=0, atol=1e-6)
    assert np.allclose(sorted(left.created_s for left in got), np.sort(came["end_s"]) + 500.3, rtol=0, atol=1e-6)
    others = log.of(CREATE).where(~np.isin(log.of(CREATE)["job"], came["job"]))
    assert rows(others) == rows(own.of(CREATE)), "jobs of the scenario's own source come as before"


def test_jobs_that_are_released_at_once_come_one_after_the_other():
    plan = replace(shipped("queue"), horizon_s=36000.0, warm_up_s=0.0)
    env = simpy.Environment()
    floor = Floor(env, plan)
    asked = [floor.release("customer") for _ in range(4)]
    env.run(until=env.all_of(asked))
    left = [event.value for event in asked]
    assert [one.number for one in left] == sorted(one.number for one in left)
    assert [one.at_s for one in left] == sorted(one.at_s for one in left)
    assert all(one.created_s == 0 and one.what == "finished" and one.units == 1 for one in left)


@pytest.mark.parametrize("name", ["assembly", "pump_plant", "work_sharing", "kanban_cell", "torque_guns"])
def test_each_product_of_any_floor_may_be_released(name):
    plan = shipped(name)
    env = simpy.Environment()
    floor, got = Floor(env, plan), []
    for product in plan.products:
        env.process(releases(env, floor, product.name, plan.horizon_s / 23.7, got))
    env.run(until=plan.horizon_s / 2)
    audit(floor.log(), floor.plan_so_far())
    env.run(until=floor.ended)
    env.run(until=env.now + 1)
    audit(floor.log(), plan)
    assert {left.product for left in got} == {product.name for product in plan.products}
    assert {left.what for left in got} <= {"finished", "scrapped", "joined", "split", "inside"}


def test_nobody_waits_for_ever_for_a_job_that_is_inside(cell):
    env = simpy.Environment()
    floor = Floor(env, cell)
    env.run(until=cell.horizon_s - 0.5)
    asked = floor.release("crate")
    env.run()
    assert (asked.value.what, asked.value.at_s, asked.value.good) == ("inside", cell.horizon_s, False)


def test_a_product_that_is_not_there_is_named(cell):
    floor = Floor(simpy.Environment(), cell)
    with pytest.raises(
        ValueError, match=r"^floor Repacking cell: release: no product 'cartoon'; did you mean 'carton'\?$"
    ):
        floor.release("cartoon")
    with pytest.raises(ValueError, match="no product nothing; its products: carton, crate"):
        floor.release(None)


def test_a_floor_that_is_over_says_so_and_keeps_its_log(cell):
    env = simpy.Environment(initial_time=100)
    floor = Floor(env, replace(cell, horizon_s=600.0, warm_up_s=0.0))
    env.run()
    with pytest.raises(FloorEnded, match="cannot release crate at 700 s: its run was over at 700 s; a longer horizon"):
        floor.release("crate")
    env.run(until=5000)
    assert floor.now_s == 600 and floor.log().horizon_s == 600


def test_an_error_on_the_floor_comes_out_of_the_run_and_the_log_stays(cell):
    class Breaks:
        def mean_duration_s(self, worker=None):
            return 5.0

        def draw_worker(self, rng, body):
            return None

        def sample(self, n, rng, *, worker=None, condition=None):
            raise ArithmeticError("no more numbers")

    tasks = tuple(replace(task, model=Breaks()) if task.name == "label" else task for task in cell.tasks)
    env = simpy.Environment()
    floor = Floor(env, replace(cell, tasks=tasks))
    with pytest.raises(ArithmeticError, match="no more numbers"):
        env.run()
    assert len(floor.log())
    env.run(until=env.now + 1000)
    with pytest.raises(FloorEnded, match=r"cannot release carton at .* s: an error ended its run at .* s"):
        floor.release("carton")


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        (lambda env, plan: (7, plan), TypeError, "expected a simpy.Environment first, found 7"),
        (lambda env, plan: (env, "cell.yaml"), TypeError, "expected a Plan second, found 'cell.yaml'; compile_plan"),
        (lambda env, plan: (env, plan, -1), ValueError, "replication must be a whole number from 0, found -1"),
        (lambda env, plan: (env, plan, True), ValueError, "replication must be a whole number from 0, found true"),
        (lambda env, plan: (simpy.Environment(1e12), plan), ValueError, "clock is at 1e\\+12 s, too late for a run of"),
        (lambda env, plan: (simpy.Environment(float("nan")), plan), ValueError, "clock is at nan s"),
    ],
)
def test_arguments_that_make_no_sense_are_named(cell, arguments, error, words):
    with pytest.raises(error, match=words):
        Floor(*arguments(simpy.Environment(), cell))
