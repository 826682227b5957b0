from stand_in_engine import stand_in

from opsim.plan import compile_plan
from opsim.study.jobs import Job, Point, Source
from opsim.study.jobs.evaluate import evaluate, loaded_of, plan_of


def test_the_order_of_changes_decides_neither_the_scenario_nor_the_plan_of_a_point():
    changes = {
        "workers.zoe.walk": "1.1 m/s",
        "workers.zoe": {"like": "ana", "home": "bench"},
        "workers.eva": {"like": "zoe"},
        "run.horizon": "2 h",
    }
    orders = (changes, dict(reversed(changes.items())))
    loaded = [loaded_of(Source("repack_cell", ()), Point("a", order)) for order in orders]
    plans = [plan_of(Source("repack_cell", (), changes={"run.horizon": "4 h"}), Point("a", order)) for order in orders]
    assert repr(loaded[0]) == repr(loaded[1])
    assert list(loaded[0].resolved["workers"]) == list(loaded[1].resolved["workers"])
    assert repr(plans[0]) == repr(plans[1]) == repr(compile_plan(loaded[0]))


def test_all_days_of_the_same_people_are_of_one_plan(monkeypatch):
    """The same object, as the fast engine uses the floor of a Plan again."""
    made, seen = stand_in(monkeypatch), []
    run = made.run_plan
    made.is_compiled = True
    monkeypatch.setattr(made, "run_plan", lambda plan, replication: (seen.append(plan), run(plan, replication))[1])
    source, point = Source("repack_cell", ("throughput_per_h",), changes={"run.horizon": "40 min"}), Point("a", {})
    for workforce, day in ((1, 0), (1, 1), (2, 0), (2, 1), (None, 0), (None, 1)):
        evaluate(source, Job(point, day, workforce), "fast")
    assert [one.workforce for one in seen] == [1, 1, 2, 2, None, None]
    assert len({id(one) for one in seen}) == 3
