"""The log of a replication as an object-centric event log: a row is an event, and tells of its objects."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan

import numpy as np

from opsim.export.event_types import FOR, attributes_of, type_names
from opsim.export.object_ids import ObjectIds
from opsim.export.object_log import Event, ObjectLog, Type, Value
from opsim.export.relations import related
from opsim.export.run_clock import RunClock
from opsim.export.things import Things
from opsim.log import EventLog
from opsim.plan import Plan

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
