"""Which objects each row of a log tells of, and what they are to it.

The log of a replication as an object-centric event log: a row is an event, and tells of its objects.

OCEL 2.0 as JSON, an event and an object a line, written one by one: no log is too long for the memory.

Every value of an attribute is text, as the published JSON schema has it; the type says what to read it as.

OCEL 2.0 as an SQLite database: a table for each type of events and objects, and what they are to each other.

With every table, column, primary and foreign key of the standard's relational schema. Names of a scenario stand in
rows alone; a table is called by letters and digits of its type.
"""

from __future__ import annotations

import json
import re
import sqlite3
from collections.abc import Collection, Iterable, Iterator
from contextlib import closing
from math import isnan
from pathlib import Path
from typing import IO, Any

import numpy as np

from opsim import log as kinds
from opsim.export.ocel_objects import (
    FLOAT,
    FOR,
    INTEGER,
    STRING,
    TIME,
    Event,
    ObjectIds,
    ObjectLog,
    Related,
    Thing,
    Things,
    Type,
    Value,
    attributes_of,
    type_names,
)
from opsim.export.tables import FIRST, RunClock
from opsim.files import whole_file
from opsim.log import EventLog
from opsim.plan import Plan

AT, TOWARDS, BY, JOB, INTO, MADE_FROM = "at", "towards", "by", "job", "into", "made from"
VEHICLE, TOOL, OF_ORDER = "vehicle", "tool", "of order"
"""Qualifiers: station it is at or goes to, worker it is done by, job, jobs it becomes or came from, vehicle, tool."""


def related(log: EventLog, ids: ObjectIds, rows: list[int]) -> Iterator[Related]:
    """(id, qualifier) of the objects of each of some rows. The station of a paced line is its first.

    A walk to a job, or a wait beside one, is the worker's and not the job's, which at that time is held or in a queue:
    so the events of a job follow one another.
    """
    columns = (log[name][rows].tolist() for name in ("kind", "worker", "station", "job", "k"))
    for kind, worker, station, job, k in zip(*columns):
        found: list[tuple[str, str]] = []
        if job >= 0 and kind not in BESIDE:
            found.append((ids.job(job), JOB))
        if worker >= 0:
            found.append((ids.workers[worker], BY))
        if station >= 0:
            moves = kind in (kinds.WALK, kinds.TRANSPORT)
            found.append((ids.stations[station], TOWARDS if moves else AT))
        if kind in _OTHERS and k >= 0:
            found.append(_OTHERS[kind](ids, k))
        elif kind == kinds.TRANSPORT and k >= 0 and job < 0 and worker < 0:
            found.append((ids.vehicles[k], VEHICLE))
        if kind == kinds.CREATE and (order := ids.order(job)) is not None:
            found.append((order, OF_ORDER))
        yield tuple(dict.fromkeys(found))


BESIDE = (kinds.WALK, kinds.WAIT)
"""Kinds in which a worker is on his way to a job, or stands beside it: it is an attribute of theirs."""
_OTHERS = {
    kinds.TOOL: lambda ids, k: (ids.tools[k], TOOL),
    kinds.JOIN: lambda ids, k: (ids.job(k), INTO),
    kinds.CREATE: lambda ids, k: (ids.job(k), MADE_FROM),
}
"""Kinds whose k is the number of another object."""


_NAMES = {"from": "place_from", "to": "place_to", "place": "place_to", "reason": "cause"}
_NUMBERS = {"performance": "performance_id", "occurrence": "k"}
"""Attributes that the log calls otherwise; but for ``end`` and ``duration_s``, the others are called as its columns."""


def object_log(log: EventLog, plan: Plan, clock: RunClock, *, by_task: bool = False) -> ObjectLog:
    """Every row as an event at the row's start; what lasts has ``end`` and ``duration_s``.

    by_task : work and set-up are events of a type for each task
    """
    names = type_names(log, by_task)
    types = dict(sorted(set(zip(names, log["kind"].tolist()))))
    things = Things(log, plan, ObjectIds(plan), clock)
    return ObjectLog(
        tuple(Type(name, attributes_of(kind)) for name, kind in types.items()),
        things.types(),
        sum(1 for _ in things),
        lambda: _events(log, things.ids, clock, names),
        lambda: iter(things),
    )


def _events(log: EventLog, ids: ObjectIds, clock: RunClock, names: list[str]) -> Iterator[Event]:
    """In order of their starts; at one instant what lasts no time comes first."""
    rows = np.lexsort([np.arange(len(log)), log["end_s"], log["start_s"]]).tolist()
    width = len(str(len(log)))
    times, values = clock.texts(log["start_s"][rows]), _values(log, ids, clock, rows)
    for n, (row, time, own, near) in enumerate(zip(rows, times, values, related(log, ids, rows))):
        yield Event(f"e{n:0{width}d}", names[row], time, own, near)


def _values(log: EventLog, ids: ObjectIds, clock: RunClock, rows: list[int]) -> Iterator[tuple[tuple[str, Value], ...]]:
    """The attributes of some rows, without those they do not have."""
    listed = log["kind"][rows].tolist()
    wanted = {kind: [name for name, _ in attributes_of(kind)] for kind in set(listed)}
    columns = {name: _column(log, ids, clock, name, rows) for name in {name for own in wanted.values() for name in own}}
    for at, kind in enumerate(listed):
        found = ((name, columns[name][at]) for name in wanted[kind])
        yield tuple((name, value) for name, value in found if value is not None)


def _column(log: EventLog, ids: ObjectIds, clock: RunClock, name: str, rows: list[int]) -> list[Value | None]:
    """(rows,) the value of an attribute; None where a row has none."""
    if name == "end":
        return [*clock.texts(log["end_s"][rows])]
    if name == FOR[0]:
        return [ids.job(job) if job >= 0 else None for job in log["job"][rows].tolist()]
    if name == "duration_s":
        return log.duration_s[rows].tolist()
    column = _NAMES.get(name, name)
    if column in log.names:
        words = [word.replace("_", " ") or None for word in log.names[column]] if column == "cause" else None
        listed = log.names[column] if words is None else words
        return [listed[rank] if rank >= 0 else None for rank in log[column][rows].tolist()]
    found = log[_NUMBERS.get(name, column)][rows].tolist()
    if log[_NUMBERS.get(name, column)].dtype.kind == "f":
        return [None if isnan(value) else value for value in found]
    return [value if value >= 0 else None for value in found]


AT_ONCE = 2000
"""Lines written together."""
_line = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode


def write_ocel_json(log: ObjectLog, path: Path) -> None:
    """Write the log whole, or not at all. Raises OSError."""
    with whole_file(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as out:
        out.write("{\n")
        _array(out, "objectTypes", map(_type, log.object_types), ",")
        _array(out, "eventTypes", map(_type, log.event_types), ",")
        _array(out, "objects", map(_thing, log.things()), ",")
        _array(out, "events", map(_event, log.events()), "")
        out.write("}\n")


def _array(out: IO[str], name: str, items: Iterable[Any], after: str) -> None:
    out.write(f'"{name}": [')
    between = "\n"
    for some in _some(map(_line, items)):
        out.write(between + ",\n".join(some))
        between = ",\n"
    out.write(f"\n]{after}\n")


def _some(lines: Iterator[str]) -> Iterator[list[str]]:
    some: list[str] = []
    for line in lines:
        some.append(line)
        if len(some) == AT_ONCE:
            yield some
            some = []
    if some:
        yield some


def _type(one: Type) -> dict[str, Any]:
    return {"name": one.name, "attributes": [{"name": name, "type": kind} for name, kind in one.attributes]}


def _event(one: Event) -> dict[str, Any]:
    return {
        "id": one.id,
        "type": one.type,
        "time": one.time,
        "attributes": [{"name": name, "value": _text(value)} for name, value in one.values],
        "relationships": _related(one.objects),
    }


def _thing(one: Thing) -> dict[str, Any]:
    values = [{"name": name, "time": time, "value": _text(value)} for name, value, time in one.values]
    return {"id": one.id, "type": one.type, "attributes": values, "relationships": _related(one.objects)}


def _related(objects: Related) -> list[dict[str, str]]:
    return [{"objectId": name, "qualifier": qualifier} for name, qualifier in objects]


def _text(value: Value) -> str:
    return value if isinstance(value, str) else repr(value)


ROWS_AT_ONCE = 5000
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
    for things in _chunks(log.things()):
        _put_things(database, things, objects)
    for some in _chunks(log.events()):
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


def _chunks(items: Iterator) -> Iterator[list]:
    some: list = []
    for one in items:
        some.append(one)
        if len(some) == ROWS_AT_ONCE:
            yield some
            some = []
    if some:
        yield some
