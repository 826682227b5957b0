import sqlite3
from collections import Counter
from contextlib import closing

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.export.ocel import table_word, write_ocel_sqlite
from tests.opsim.export.hostile import HARMFUL, hostile
from tests.opsim.export.made_export import MANY, made, ran, shop

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


def test_the_same_log_gives_the_same_bytes(tmp_path):
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
