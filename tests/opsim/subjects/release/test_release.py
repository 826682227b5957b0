"""Jobs come when the plan says: by schedule, several at once, in a sequence, from several sources."""

import numpy as np
import pytest

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import audit
from opsim.log import COLUMNS, CREATE, FINISH
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in

TEXT = """
opsim: 1
name: sources
run: {horizon: 100 s, seed: 4}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 1 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}}
products: {a: {share: 0.5, route: [s1]}, b: {share: 0.5, route: [s1]}}
"""


def run(release, folder, text=TEXT):
    made = compile_plan(scenarios_in(f"{text}{release}\n".encode(), folder / "x.yaml")["base"])
    log = run_plan(made)
    audit(log, made)
    return log, made


def created(log):
    rows = log.of(CREATE)
    return rows["end_s"].tolist(), rows["product"].tolist()


def test_orders_come_at_their_times_also_at_the_start_and_several_at_once(tmp_path):
    (tmp_path / "orders.csv").write_text("time,product,quantity\n0,b,2\n0:00:30,a,1\n30,b,1\n99.5,a,1\n100,a,1\n")
    log, made = run("release: {kind: schedule, file: orders.csv}", tmp_path)
    assert created(log) == ([0, 0, 30, 30, 99.5], [1, 1, 0, 1, 0])
    assert (made.sources[0].n_late, made.sources[0].job_every_s(100.0)) == (1, 20.0)


def test_orders_without_a_product_are_of_the_mix(tmp_path):
    (tmp_path / "orders.csv").write_text("time,quantity\n1,40\n")
    log, _ = run("release: {kind: schedule, file: orders.csv, products: {a: 0.9, b: 0.1}}", tmp_path)
    products = created(log)[1]
    assert 30 <= products.count(0) < 40
    log, _ = run("release: {kind: schedule, file: orders.csv, sequence: [b, a, a]}", tmp_path)
    assert created(log)[1][:7] == [1, 0, 0, 1, 0, 0, 1]


def test_an_order_of_high_priority_passes_those_that_wait(tmp_path):
    text = TEXT.replace("tasks: [t]}", "tasks: [t], buffer: 0}")
    (tmp_path / "orders.csv").write_text("time,product,priority\n0,a,\n0,a,\n0,b,3\n")
    log, _ = run("release: {kind: schedule, file: orders.csv}", tmp_path, text)
    assert log.of(FINISH)["product"].tolist() == [1, 0, 0]


def test_a_schedule_without_an_order_in_time_is_silent(tmp_path):
    (tmp_path / "orders.csv").write_text("time,product\n200,a\n")
    log, made = run("release: {kind: schedule, file: orders.csv}", tmp_path)
    assert (len(log), made.sources[0].job_every_s(100.0)) == (0, None)


def test_several_jobs_come_at_each_arrival(tmp_path):
    log, made = run("release: {kind: renewal, every: {fixed: 30 s}, at_once: 4}", tmp_path)
    assert created(log)[0] == [30] * 4 + [60] * 4 + [90] * 4
    assert made.sources[0].jobs_per_s(100.0) == pytest.approx(4 / 30)


def test_gaps_may_be_a_trace_of_a_file(tmp_path):
    (tmp_path / "gaps.csv").write_text("5\n10\n2.5\n")
    log, _ = run("release: {kind: renewal, every: {recorded: gaps.csv, by: trace}}", tmp_path)
    assert created(log)[0][:5] == [5, 15, 17.5, 22.5, 32.5]


@pytest.mark.parametrize("said", ["[a, a, b]", "mix.csv"])
def test_a_sequence_is_gone_through_again_and_again(said, tmp_path):
    (tmp_path / "mix.csv").write_text("product,quantity\na,2\nb,1\n")
    log, made = run(f"release: {{kind: renewal, every: {{fixed: 10 s}}, sequence: {said}}}", tmp_path)
    assert created(log)[1] == [0, 0, 1, 0, 0, 1, 0, 0, 1]
    assert made.sources[0].mix == ((0, 2 / 3), (1, 1 / 3))


def test_a_source_more_moves_nobody_else_s_luck_and_no_two_jobs_have_one_number(tmp_path):
    one = "sources: {m: {kind: poisson, every: 7 s}}"
    more = "sources: {m: {kind: poisson, every: 7 s}, c: {kind: poisson, every: 9 s, products: [b]}}"
    alone, beside = run(one, tmp_path)[0], run(more, tmp_path)[0]
    mine = beside.of(CREATE).where(beside.of(CREATE)["source"] == 1)
    assert created(alone) == created(mine)
    jobs = beside.of(CREATE)["job"]
    assert np.unique(jobs).size == jobs.size
    assert beside.names["source"] == ("c", "m")


def test_a_release_is_the_source_called_release(tmp_path):
    single = run("release: {kind: poisson, every: 7 s}", tmp_path)[0]
    named = run("sources: {release: {kind: poisson, every: 7 s}}", tmp_path)[0]
    assert all(np.array_equal(single[c], named[c], equal_nan=True) for c in COLUMNS if single[c].dtype.kind == "f")
    assert np.array_equal(single["job"], named["job"])


def test_the_order_in_which_sources_are_declared_decides_nothing(tmp_path):
    x, y = "x: {kind: renewal, every: {fixed: 5 s}, products: [a]}", "y: {kind: saturated, products: [b]}"
    text = TEXT.replace("tasks: [t]}", "tasks: [t], buffer: 1}")
    logs = [run(f"sources: {{{one}, {other}}}", tmp_path, text)[0] for one, other in ((x, y), (y, x))]
    assert all(np.array_equal(logs[0][c], logs[1][c], equal_nan=logs[0][c].dtype.kind == "f") for c in COLUMNS)
