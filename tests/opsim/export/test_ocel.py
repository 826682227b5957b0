import json
import re
import sqlite3
from collections import Counter
from contextlib import closing
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.export.ocel import table_word, write_ocel_json, write_ocel_sqlite
from opsim.log import CREATE, WALK
from tests.json_schema import complaints
from tests.opsim.export.hostile import HARMFUL, hostile
from tests.opsim.export.made_export import MANY, made, ran, shop
from tests.opsim.export.ocel20_schema import ATTRIBUTE_TYPES, SCHEMA

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


DATE_TIME = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}\.[0-9]{6}Z")


def without_format(schema):
    """The words that our validator knows; times are looked at by themselves."""
    if isinstance(schema, dict):
        return {key: without_format(value) for key, value in schema.items() if key != "format"}
    return schema


@pytest.fixture(scope="module", params=[*MANY, "hostile"])
def document(request, tmp_path_factory):
    log, plan = ran(MANY[0] if request.param == "hostile" else request.param)
    if request.param == "hostile":
        log, plan = hostile(log, plan)
    found, path = made(log, plan), tmp_path_factory.mktemp("ocel") / "log.jsonocel"
    write_ocel_json(found, path)
    return found, json.loads(path.read_text(encoding="utf-8")), path


def test_it_is_what_the_published_schema_asks_for(document):
    _, read, _ = document
    assert list(complaints(read, without_format(SCHEMA))) == []
    times = [one["time"] for one in read["events"]]
    times += [value["time"] for one in read["objects"] for value in one["attributes"]]
    assert all(DATE_TIME.fullmatch(time) for time in times)


def test_it_holds_every_event_and_object_as_they_are(document):
    found, read, _ = document
    assert [one.id for one in found.events()] == [one["id"] for one in read["events"]]
    assert [one.id for one in found.things()] == [one["id"] for one in read["objects"]]
    some = dict(zip([one.id for one in found.events()], found.events()))
    for one in read["events"][::97]:
        event = some[one["id"]]
        assert {value["name"]: value["value"] for value in one["attributes"]} == {
            name: value if isinstance(value, str) else repr(value) for name, value in event.values
        }
        assert tuple((near["objectId"], near["qualifier"]) for near in one["relationships"]) == event.objects


def test_the_same_log_gives_the_same_bytes(document, tmp_path):
    found, _, path = document
    write_ocel_json(found, tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == path.read_bytes()


def test_harmful_names_come_back_as_they_were(tmp_path):
    log, plan = hostile(*ran("pump_plant"))
    write_ocel_json(made(log, plan), tmp_path / "log.json")
    read = json.loads((tmp_path / "log.json").read_text(encoding="utf-8"))
    names = {one["id"] for one in read["objects"]}
    assert {f"worker {name}" for name in HARMFUL} <= names
    assert [path.name for path in tmp_path.iterdir()] == ["log.json"]


def test_nothing_is_left_where_it_cannot_be_finished(tmp_path):
    log, plan = ran("pump_plant")
    (tmp_path / "folder").mkdir()
    with pytest.raises(OSError, match="folder"):
        write_ocel_json(made(log, plan), tmp_path / "folder")
    assert list((tmp_path).iterdir()) == [tmp_path / "folder"]


OWN = ("event", "object", "event_object", "object_object", "event_map_type", "object_map_type")


@pytest.fixture(scope="module", params=[*MANY, "hostile"])
def database(request, tmp_path_factory):
    log, plan = ran(MANY[0] if request.param == "hostile" else request.param)
    if request.param == "hostile":
        log, plan = hostile(log, plan)
    found, path = made(log, plan), tmp_path_factory.mktemp("ocel") / "log.sqlite"
    write_ocel_sqlite(found, path)
    with closing(sqlite3.connect(path)) as connection:
        yield found, connection


def columns(connection, table):
    """(name, type, place in the primary key) of each column."""
    return {name: (kind, key) for _, name, kind, _, _, key in connection.execute(f'PRAGMA table_info("{table}")')}


def foreign(connection, table):
    return {(row[2], row[3], row[4]) for row in connection.execute(f'PRAGMA foreign_key_list("{table}")')}


def test_the_tables_of_the_standard_are_there_with_their_keys(database):
    _, connection = database
    tables = {name for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
    typed = {
        f"{what}_{word}"
        for what in ("event", "object")
        for (word,) in connection.execute(f"SELECT ocel_type_map FROM {what}_map_type")
    }
    assert tables == {*OWN, *typed}
    for what in ("event", "object"):
        assert columns(connection, f"{what}_map_type") == {"ocel_type": ("TEXT", 1), "ocel_type_map": ("TEXT", 0)}
        assert columns(connection, what) == {"ocel_id": ("TEXT", 1), "ocel_type": ("TEXT", 0)}
        assert foreign(connection, what) == {(f"{what}_map_type", "ocel_type", "ocel_type")}
    assert [key for _, key in columns(connection, "event_object").values()] == [1, 2, 3]
    assert [key for _, key in columns(connection, "object_object").values()] == [1, 2, 3]
    assert foreign(connection, "event_object") == {
        ("event", "ocel_event_id", "ocel_id"),
        ("object", "ocel_object_id", "ocel_id"),
    }
    assert foreign(connection, "object_object") == {
        ("object", "ocel_source_id", "ocel_id"),
        ("object", "ocel_target_id", "ocel_id"),
    }


def test_the_tables_of_types_have_times_and_typed_columns(database):
    found, connection = database
    for what, types in (("event", found.event_types), ("object", found.object_types)):
        words = dict(connection.execute(f"SELECT ocel_type, ocel_type_map FROM {what}_map_type"))
        assert list(words) == [kind.name for kind in types]
        for kind in types:
            own = columns(connection, f"{what}_{words[kind.name]}")
            assert own["ocel_time"][0] == "TIMESTAMP" and own["ocel_id"] == ("TEXT", int(what == "event"))
            assert ("ocel_changed_field" in own) == (what == "object")
            assert set(own) >= {name for name, _ in kind.attributes}
            assert foreign(connection, f"{what}_{words[kind.name]}") == {(what, "ocel_id", "ocel_id")}


def test_no_key_leads_nowhere(database):
    _, connection = database
    assert connection.execute("PRAGMA foreign_key_check").fetchall() == []
    assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_it_holds_every_event_object_relation_and_change(database):
    found, connection = database
    events, things = list(found.events()), list(found.things())
    assert connection.execute("SELECT ocel_id, ocel_type FROM event ORDER BY ocel_id").fetchall() == [
        (one.id, one.type) for one in events
    ]
    assert Counter(connection.execute("SELECT * FROM event_object")) == Counter(
        (one.id, *near) for one in events for near in one.objects
    )
    assert Counter(connection.execute("SELECT * FROM object_object")) == Counter(
        (one.id, *near) for one in things for near in one.objects
    )
    changes = Counter()
    for (word,) in connection.execute("SELECT ocel_type_map FROM object_map_type").fetchall():
        query = f"SELECT ocel_id FROM \"object_{word}\" WHERE ocel_changed_field = 'state'"
        changes.update(name for (name,) in connection.execute(query))
    expected = Counter({one.id: sum(name == "state" for name, *_ in one.values) - 1 for one in things})
    assert changes == +expected


def test_numbers_come_back_to_the_last_digit(tmp_path):
    log, plan = shop(tmp_path)
    found = made(log, plan)
    write_ocel_sqlite(found, tmp_path / "log.sqlite")
    with closing(sqlite3.connect(tmp_path / "log.sqlite")) as connection:
        rows = dict(connection.execute("SELECT ocel_id, duration_s FROM event_Work"))
    assert rows == {one.id: dict(one.values)["duration_s"] for one in found.events() if one.type == "work"}


def test_the_same_log_gives_the_same_bytes_of_ocel_sqlite(tmp_path):
    found = made(*ran("assembly"))
    for name in ("a.sqlite", "b.sqlite"):
        write_ocel_sqlite(found, tmp_path / name)
    assert (tmp_path / "a.sqlite").read_bytes() == (tmp_path / "b.sqlite").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.sqlite", "b.sqlite"]


def test_harmful_names_stand_in_rows_and_nowhere_else(tmp_path):
    write_ocel_sqlite(made(*hostile(*ran("pump_plant"))), tmp_path / "log.sqlite")
    with closing(sqlite3.connect(tmp_path / "log.sqlite")) as connection:
        names = {name for (name,) in connection.execute("SELECT ocel_id FROM object WHERE ocel_type = 'worker'")}
        tables = [name for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
    assert {f"worker {name}" for name in HARMFUL} <= names
    assert all(name.replace("_", "").isalnum() for name in tables)


@given(st.lists(st.text(max_size=8), unique=True, max_size=12))
def test_table_names_are_plain_and_no_two_are_alike(names):
    words = []
    for name in names:
        words.append(table_word(name, words))
    assert all(word.replace("_", "").isalnum() and word.isascii() for word in words)
    assert len({word.casefold() for word in words}) == len(words)
    assert not {"object", "map_type"} & {word.casefold() for word in words}
