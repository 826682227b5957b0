from types import SimpleNamespace

from opsim.ergonomics.redraw import luck_of
from opsim.ergonomics.shift.external import groups, models_of, plan_of
from opsim.external_draws import OwnLuck
from opsim.plan.tasks import NOT_SAID, Handling
from opsim.tasks import Fixed

BODY, OTHER = object(), object()


def luck(name, models, handling=None, **how):
    one = OwnLuck(name, models, how.pop("seed", 1), 0, **how)
    one.handling = handling or {}
    return one


def by_name(*lucks):
    return {one.worker: one for one in lucks}


def test_who_means_the_same_by_a_task_is_in_one_group():
    same = by_name(luck("w10", {"a": BODY}), luck("w2", {"a": BODY, "b": OTHER}, seed=9), luck("x", {"c": BODY}))
    assert groups(same) == [["w2", "w10", "x"]]
    assert groups(by_name(luck("ana", {"a": Fixed(1.0)}), luck("ben", {"a": Fixed(2.0)}))) == [["ana", "ben"]]
    assert groups(by_name(luck("ana", {"a": BODY}), luck("ben", {"a": OTHER}), luck("cy", {"a": BODY}))) == [
        ["ana", "cy"],
        ["ben"],
    ]
    heavy = {"a": Handling(load_kg=9.0)}
    assert groups(by_name(luck("ana", {"a": BODY}, heavy), luck("ben", {"a": BODY}))) == [["ana"], ["ben"]]


def test_ranks_are_natural_and_models_those_of_the_group():
    lucks = by_name(luck("w10", {"t10": BODY, "t2": BODY}), luck("w2", {"t2": OTHER}))
    for name, model in (("w10", BODY), ("w2", OTHER)):
        plan = plan_of(lucks, [name])
        assert [worker.name for worker in plan.workers] == ["w2", "w10"]
        assert [task.name for task in plan.tasks] == ["t2", "t10"] and plan.tasks[0].model is model
    assert models_of(lucks.values()) == {"t2": OTHER, "t10": BODY}


def test_everybody_has_his_own_luck():
    lucks = by_name(luck("ana", {"a": BODY}), luck("ben", {"a": BODY}, seed=8))
    plan = plan_of(lucks, ["ana", "ben"])
    assert [luck_of(plan, rank, 0) for rank in (0, 1)] == [lucks["ana"], lucks["ben"]]


def test_what_is_said_now_comes_before_what_a_worker_says():
    own, now = Handling(load_kg=1.0), Handling(load_kg=2.0)
    lucks = by_name(luck("ana", {"a": BODY, "b": BODY, "c": BODY}, {"a": own, "b": own}))
    plan = plan_of(lucks, ["ana"], {"b": now}, window_s=(5.0, 9.0), start_s=60.0)
    assert [task.handling for task in plan.tasks] == [own, now, NOT_SAID]
    assert plan.window_s == (5.0, 9.0) and plan.start_s == 60.0


def test_a_body_is_read_from_keys_and_from_attributes():
    for body in ({"height_m": 1.7, "sex": "f"}, SimpleNamespace(height_m=1.7, sex="f")):
        plan = plan_of(by_name(luck("ana", {"a": BODY}, body=body)), ["ana"])
        assert (plan.workers[0].body.height_m, plan.workers[0].body.sex) == (1.7, "f")
        assert plan.workers[0].body.mass_kg is None
