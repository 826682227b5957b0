"""OCEL 2.0 as an SQLite database: a table for each type of events and objects, and what they are to each other.

With every table, column, primary and foreign key of the standard's relational schema. Names of a scenario stand in
rows alone; a table is called by letters and digits of its type.
"""

from __future__ import annotations

import re
import sqlite3
from collections.abc import Collection, Iterable, Iterator
from contextlib import closing
from pathlib import Path

from opsim.export.object_log import FLOAT, INTEGER, STRING, TIME, Event, ObjectLog, Thing, Type
from opsim.export.run_clock import FIRST
from opsim.whole import whole_file

AT_ONCE = 5000
"""Events, or objects, put in together."""
_SQL = {STRING: "TEXT", TIME: "TIMESTAMP", INTEGER: "INTEGER", FLOAT: "REAL"}
_TABLES = """
CREATE TABLE event_map_type (ocel_type TEXT PRIMARY KEY, ocel_type_map TEXT);
CREATE TABLE object_map_type (ocel_type TEXT PRIMARY KEY, ocel_type_map TEXT);
CREATE TABLE event (ocel_id TEXT PRIMARY KEY, ocel_type TEXT, FOREIGN KEY (ocel_type) REFERENCES event_map_type (ocel_type));
CREATE TABLE object (ocel_id TEXT PRIMARY KEY, ocel_type TEXT, FOREIGN KEY (ocel_type) REFERENCES object_map_type (ocel_type));
CREATE TABLE event_object (ocel_event_id TEXT, ocel_object_id TEXT, ocel_qualifier TEXT,
  PRIMARY KEY (ocel_event_id, ocel_object_id, ocel_qualifier),
  FOREIGN KEY (ocel_event_id) REFERENCES event (ocel_id), FOREIGN KEY (ocel_object_id) REFERENCES object (ocel_id));
CREATE TABLE object_object (ocel_source_id TEXT, ocel_target_id TEXT, ocel_qualifier TEXT,
  PRIMARY KEY (ocel_source_id, ocel_target_id, ocel_qualifier),
  FOREIGN KEY (ocel_source_id) REFERENCES object (ocel_id), FOREIGN KEY (ocel_target_id) REFERENCES object (ocel_id));
"""  # noqa: E501
_OF_EVENTS = 'CREATE TABLE "{}" (ocel_id TEXT PRIMARY KEY, ocel_time TIMESTAMP{}, FOREIGN KEY (ocel_id) REFERENCES event (ocel_id))'  # noqa: E501
_OF_OBJECTS = 'CREATE TABLE "{}" (ocel_id TEXT, ocel_time TIMESTAMP, ocel_changed_field TEXT{}, FOREIGN KEY (ocel_id) REFERENCES object (ocel_id))'  # noqa: E501
_TAKEN = {"object", "map_type"}
"""Endings that with ``event_`` and ``object_`` are tables of the standard's own."""


def write_ocel_sqlite(log: ObjectLog, path: Path) -> None:
    """Write the database whole, or not at all; the same log gives the same bytes. Raises OSError."""
    with whole_file(path) as temporary:
        try:
            with closing(sqlite3.connect(temporary, isolation_level=None)) as database:
                database.execute("PRAGMA journal_mode = OFF")
                database.execute("PRAGMA synchronous = OFF")  # ``whole_file`` sees to it
                database.execute("BEGIN")
                _fill(database, log)
                database.execute("COMMIT")
        except sqlite3.OperationalError as error:
            raise OSError(f"{path}: cannot be written: {error}") from error


def _fill(database: sqlite3.Connection, log: ObjectLog) -> None:
    for statement in _TABLES.strip().split(";\n"):
        database.execute(statement)
    events = _typed(database, "event", _OF_EVENTS, log.event_types)
    objects = _typed(database, "object", _OF_OBJECTS, log.object_types)
    for things in _some(log.things()):
        _put_things(database, things, objects)
    for some in _some(log.events()):
        _put_events(database, some, events)


def _typed(database: sqlite3.Connection, what: str, form: str, types: Iterable[Type]) -> dict[str, tuple[str, Type]]:
    """A table for each type: (its name, the type) by the name of the type."""
    found: dict[str, tuple[str, Type]] = {}
    for one in types:
        word = table_word(one.name, [name.removeprefix(f"{what}_") for name, _ in found.values()])
        database.execute(f"INSERT INTO {what}_map_type VALUES (?, ?)", (one.name, word))
        columns = "".join(f', "{name}" {_SQL[kind]}' for name, kind in one.attributes)
        database.execute(form.format(f"{what}_{word}", columns))
        found[one.name] = f"{what}_{word}", one
    return found


def table_word(name: str, others: Collection[str]) -> str:
    """Letters and digits of a type's name, as no other has; SQLite does not tell capitals from small letters."""
    word = "".join(part[:1].upper() + part[1:] for part in re.findall(r"[A-Za-z0-9]+", name)) or "Type"
    taken = {other.casefold() for other in others} | _TAKEN
    numbered = (word if n == 1 else f"{word}_{n}" for n in range(1, len(taken) + 2))
    return next(one for one in numbered if one.casefold() not in taken)


def _put_events(database: sqlite3.Connection, events: list[Event], tables: dict[str, tuple[str, Type]]) -> None:
    database.executemany("INSERT INTO event VALUES (?, ?)", ((one.id, one.type) for one in events))
    pairs = ((one.id, *near) for one in events for near in one.objects)
    database.executemany("INSERT INTO event_object VALUES (?, ?, ?)", pairs)
    for table, kind in tables.values():
        own = [one for one in events if one.type == kind.name]
        rows = ((one.id, one.time, *_in_columns(dict(one.values), kind)) for one in own)
        _insert(database, table, 2 + len(kind.attributes), rows)


def _put_things(database: sqlite3.Connection, things: list[Thing], tables: dict[str, tuple[str, Type]]) -> None:
    database.executemany("INSERT INTO object VALUES (?, ?)", ((one.id, one.type) for one in things))
    pairs = ((one.id, *near) for one in things for near in one.objects)
    database.executemany("INSERT INTO object_object VALUES (?, ?, ?)", pairs)
    for table, kind in tables.values():
        rows = (row for one in things if one.type == kind.name for row in _rows_of(one, kind))
        _insert(database, table, 3 + len(kind.attributes), rows)


def _rows_of(thing: Thing, kind: Type) -> Iterator[tuple]:
    """What holds from the beginning in one row, then a row for each change."""
    first = {name: value for name, value, time in thing.values if time == FIRST}
    yield (thing.id, FIRST, None, *_in_columns(first, kind))
    for name, value, time in thing.values:
        if time != FIRST:
            yield (thing.id, time, name, *_in_columns({name: value}, kind))


def _in_columns(values: dict, kind: Type) -> tuple:
    return tuple(values.get(name) for name, _ in kind.attributes)


def _insert(database: sqlite3.Connection, table: str, n_columns: int, rows: Iterable[tuple]) -> None:
    database.executemany(f'INSERT INTO "{table}" VALUES ({", ".join("?" * n_columns)})', rows)


def _some(items: Iterator) -> Iterator[list]:
    some: list = []
    for one in items:
        some.append(one)
        if len(some) == AT_ONCE:
            yield some
            some = []
    if some:
        yield some
