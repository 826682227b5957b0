"""OCEL 2.0 as JSON, an event and an object a line, written one by one: no log is too long for the memory.

Every value of an attribute is text, as the published JSON schema has it; the type says what to read it as.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO, Any

from opsim.export.object_log import Event, ObjectLog, Related, Thing, Type, Value
from opsim.whole import whole_file

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
