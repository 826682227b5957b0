"""Layouts of structs: which field lies where, in words of 8 bytes, from the annotations of a class."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

WORD = 8
LIST_WORDS = 4
"""Of a list inside a struct: where its items are, the number of the first, how many, and for how many there is room."""
_SCALARS = {"int": "int", "bool": "int", "float": "float", "Call": "int"}
"""NOTE: a Call is the line of a step in the table."""
_GENERIC = re.compile(r"(List|Array)\[(.+)\]$")


@dataclass(frozen=True)
class Field:
    """kind : ``int``, ``float``, ``ref``, ``list`` or ``array``; of : what a reference leads to, what items are

    at : bytes from the beginning of the struct
    """

    kind: str
    of: str
    at: int

    @property
    def words(self) -> int:
        return LIST_WORDS if self.kind == "list" else 1


@dataclass(frozen=True)
class Layout:
    """name : of the struct; fields by name, in their order; size : bytes."""

    name: str
    fields: dict[str, Field]
    size: int


LAYOUTS: dict[str, Layout] = {}


def layout_of(cls: Any) -> Layout:
    """The layout of a class of annotations, known by its name from now on. Raises ValueError for a name taken."""
    fields: dict[str, Field] = {}
    at = 0
    for name, said in cls.__annotations__.items():
        field = _field(said if isinstance(said, str) else said.__name__, at)
        fields[name] = field
        at += field.words * WORD
    made = Layout(cls.__name__, fields, at)
    if LAYOUTS.get(made.name, made) != made:
        raise ValueError(f"two structs are called {made.name}")
    LAYOUTS[made.name] = made
    return made


def _field(said: str, at: int) -> Field:
    said = re.sub(r"\b\w+\.", "", said)
    generic = _GENERIC.match(said)
    if generic is not None:
        return Field(generic[1].lower(), _SCALARS.get(generic[2], generic[2]), at)
    if said in _SCALARS:
        return Field(_SCALARS[said], "", at)
    return Field("ref", said, at)
