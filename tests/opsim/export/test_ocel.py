from itertools import pairwise

import numpy as np
import pytest

from opsim.log import CREATE, WALK
from tests.opsim.export.hostile import hostile
from tests.opsim.export.made_export import MANY, made, ran, shop
from tests.opsim.export.ocel20_schema import ATTRIBUTE_TYPES

KINDS_OF_VALUES = {"string": str, "time": str, "integer": int, "float": float}


@pytest.fixture(scope="module", params=[*MANY, "hostile"])
def log_and_made(request):
    log, plan = ran(MANY[0] if request.param == "hostile" else request.param)
    if request.param == "hostile":
        log, plan = hostile(log, plan)
    return log, plan, made(log, plan)


def test_a_shop_as_events_and_objects(tmp_path):
    log, plan = shop(tmp_path)
    found = made(log, plan)
    events = list(found.events())
    things = {one.id: one for one in found.things()}
    first = events[:4]
    assert [(one.type, one.time) for one in first if one.type == "create"] == 2 * [
        ("create", "2026-01-06T06:00:00.000000Z")
    ]
    assert first[0].objects == (("job 0", "job"), ("order release #1", "of order"))
    cut = next(one for one in events if one.type == "work" and dict(one.values)["task"] == "cut")
    assert cut.objects == (("job 0", "job"), ("worker ana", "by"), ("station saw", "at"))
    assert dict(cut.values)["duration_s"] == 20.0 and dict(cut.values)["end"] == "2026-01-06T06:00:25.000000Z"
    assert things["job 0"].type == "job part" and things["job 0"].objects == (("order release #1", "of order"),)
    assert things["job 2"].objects == (("order release #2", "of order"),)
    due = {name: value for name, value, _ in things["job 2"].values}["due"]
    assert due == "2026-01-06T06:06:40.000000Z"  # as its order says
    assert {n: v for n, v, _ in things["job 0"].values}["due"] == "2026-01-06T06:10:00.000000Z"  # as its product
    assert [one.type for one in things.values()].count("order") == 3
    states = [(value, time) for name, value, time in things["worker ana"].values if name == "state"]
    assert states[0] == ("walk", "1970-01-01T00:00:00.000000Z")
    assert {name for name, *_ in things["worker ana"].values} == {"home", "walk_m_per_s", "height_m", "state"}


def test_every_row_is_an_event_in_order_of_time_with_objects_that_are_there(log_and_made):
    log, _, found = log_and_made
    events, things = list(found.events()), list(found.things())
    ids = [one.id for one in things]
    assert len(events) == len(log) and len({one.id for one in events}) == len(events)
    assert found.n_things == len(ids) == len(set(ids))
    assert [one.time for one in events] == sorted(one.time for one in events)
    assert [one.id for one in events] == sorted(one.id for one in events)
    for one in (*events, *things):
        assert len(set(one.objects)) == len(one.objects)
        assert {name for name, _ in one.objects} <= set(ids)
    assert all(one.objects for one in events)
    assert set(ids) <= {name for one in events for name, _ in one.objects}


def test_every_attribute_is_declared_and_of_its_type(log_and_made):
    _, _, found = log_and_made
    of_events = {kind.name: dict(kind.attributes) for kind in found.event_types}
    of_things = {kind.name: dict(kind.attributes) for kind in found.object_types}
    assert {kind for own in (*of_events.values(), *of_things.values()) for kind in own.values()} <= ATTRIBUTE_TYPES
    for one in found.events():
        for name, value in one.values:
            assert isinstance(value, KINDS_OF_VALUES[of_events[one.type][name]]), (one.type, name)
    for one in found.things():
        for name, value, _ in one.values:
            assert isinstance(value, KINDS_OF_VALUES[of_things[one.type][name]]), (one.type, name)
    assert {one.type for one in found.events()} == set(of_events)
    assert {one.type for one in found.things()} == set(of_things)


def test_the_events_of_a_job_begin_with_its_creation_and_a_walk_is_none_of_them(log_and_made):
    log, _, found = log_and_made
    first, jobs = {}, int(np.sum(log["kind"] == CREATE))
    for one in found.events():
        for name, qualifier in one.objects:
            if qualifier == "job":
                first.setdefault(name, one.type)
                assert one.type not in ("walk", "wait")
    assert set(first.values()) == {"create"} and len(first) == jobs
    walks = [dict(one.values) for one in found.events() if one.type == "walk"]
    assert len(walks) == int(np.sum(log["kind"] == WALK))
    assert all(walk["from"] and walk["to"] for walk in walks)


def test_joined_and_split_jobs_know_each_other():
    log, plan = ran("assembly")
    found = made(log, plan)
    qualifiers = {qualifier for one in found.things() for _, qualifier in one.objects}
    assert {"made from", "joined into", "works at"} <= qualifiers
    joins = [one for one in found.events() if one.type == "join"]
    assert joins and all({qualifier for _, qualifier in one.objects} >= {"job", "into"} for one in joins)


def test_by_task_work_is_an_event_type_for_each_task():
    log, plan = ran("pump_plant")
    names = {kind.name for kind in made(log, plan, by_task=True).event_types}
    tasks = {plan.tasks[rank].name for rank in np.unique(log["task"][log["kind"] == 0]).tolist()}
    assert {f"work: {task}" for task in tasks} <= names and "work" not in names


def test_a_state_holds_until_the_next_one_and_no_two_neighbours_are_the_same(log_and_made):
    _, _, found = log_and_made
    for one in found.things():
        states = [(time, value) for name, value, time in one.values if name == "state"]
        assert not states or states[0][0] == "1970-01-01T00:00:00.000000Z"
        assert all(a[1] != b[1] for a, b in pairwise(states))
        assert [time for time, _ in states] == sorted(time for time, _ in states)
