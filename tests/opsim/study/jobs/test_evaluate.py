from opsim.plan import compile_plan
from opsim.study.jobs import Point, Source
from opsim.study.jobs.evaluate import loaded_of, plan_of


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
