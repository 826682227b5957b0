"""An object-centric event log as OCEL 2.0 has it, whatever file it goes to: types, then events and objects in turn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

Value = str | int | float
Related = tuple[tuple[str, str], ...]
"""(id of an object, qualifier) of each."""
STRING, TIME, INTEGER, FLOAT = "string", "time", "integer", "float"
"""Types of attributes; the standard has ``boolean`` too."""


@dataclass(frozen=True)
class Type:
    """Of events or objects; attributes : (name, one of the types above) of all that one of them may have."""

    name: str
    attributes: tuple[tuple[str, str], ...] = ()


class Event(NamedTuple):
    """time : ISO 8601; values : (attribute, value) of those that it has."""

    id: str
    type: str
    time: str
    values: tuple[tuple[str, Value], ...]
    objects: Related


class Thing(NamedTuple):
    """An object. values : (attribute, value, since when) of each it ever had, in order of time; objects : related."""

    id: str
    type: str
    values: tuple[tuple[str, Value, str], ...]
    objects: Related


@dataclass(frozen=True)
class ObjectLog:
    """n_things : objects; events, things : each call begins anew; events come in order of time."""

    event_types: tuple[Type, ...]
    object_types: tuple[Type, ...]
    n_things: int
    events: Callable[[], Iterator[Event]]
    things: Callable[[], Iterator[Thing]]
