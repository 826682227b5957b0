"""Structs of raw memory as compiled code sees them: references with named fields, lists and arrays of them.

``@struct`` turns a class of annotations into a layout in words of 8 bytes; a function annotated with the class gets a
reference to such a struct. References are plain pointers: nothing is counted, nothing is checked. ``if job.worker:``
asks whether there is one, ``job.worker = NOTHING`` takes it away, ``is`` compares.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

WORD = 8
LIST_WORDS = 4
"""Of a list inside a struct: where its items are, the number of the first, how many, and for how many there is room."""
_SCALARS = {"int": "int", "bool": "int", "float": "float", "Call": "int"}
"""NOTE: a Call is the line of a step in the table."""
_GENERIC = re.compile(r"(List|Array)\[(.+)\]$")
_NAMED = re.compile(r"Annotated\[Any, ['\"](\w+)['\"]\]$")
"""Of a struct that is defined elsewhere: ``Annotated[Any, "Name"]``."""


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
    named = _NAMED.match(said)
    if named is not None:
        return Field("ref", named[1], at)
    generic = _GENERIC.match(said)
    if generic is not None:
        return Field(generic[1].lower(), _SCALARS.get(generic[2], generic[2]), at)
    if said in _SCALARS:
        return Field(_SCALARS[said], "", at)
    return Field("ref", said, at)


T = TypeVar("T")
NOTHING: Any = None
"""Where a reference leads that leads nowhere."""


class Array(Generic[T]):
    """Words side by side, for type checkers: ``array[i]``. There is no length."""

    def __getitem__(self, item: int) -> T:
        raise NotImplementedError

    def __setitem__(self, item: int, value: T) -> None:
        raise NotImplementedError


class List(Array[T]):
    """A list inside a struct, for type checkers: ``len(list)``, ``list[i]``, and the functions of ``lists``."""

    def __len__(self) -> int:
        raise NotImplementedError


def struct(cls: type[T]) -> type[T]:
    """A class of annotations: int, float, bool, another struct, List[...] or Array[...] of those."""
    layout_of(cls)
    return cls


def size_of(struct: Any) -> int:
    """Bytes of a struct, a multiple of 16."""
    return -(-LAYOUTS[struct.__name__].size // (2 * WORD)) * 2 * WORD


@dataclass(frozen=True)
class Kind:
    """What a value of compiled code is. kind : ``int``, ``float``, ``bool``, ``none``, ``ref``, ``list``, ``array`` or
    ``tuple``; of : which struct, or what items are; items : of a tuple
    """

    kind: str
    of: str = ""
    items: tuple[Kind, ...] = ()

    @property
    def is_pointer(self) -> bool:
        return self.kind in ("ref", "list", "array", "none")

    @property
    def item(self) -> Kind:
        """Of a list or an array."""
        return Kind(self.of) if self.of in ("int", "float") else Kind("ref", self.of)

    @property
    def said(self) -> str:
        """In words, for errors."""
        words = {"ref": f"a {self.of}", "list": f"a list of {self.of}", "array": f"an array of {self.of}"}
        return {**words, "none": "nothing", "tuple": "a tuple"}.get(self.kind, self.kind)

    @property
    def llvm(self) -> str:
        """LLVM's name for it."""
        if self.kind == "tuple":
            return "{" + ", ".join(one.llvm for one in self.items) + "}"
        return {"int": "i64", "float": "double", "bool": "i1"}.get(self.kind, "ptr")


INT, FLOAT, BOOL, NONE = Kind("int"), Kind("float"), Kind("bool"), Kind("none")


def field_kind(field: Field) -> Kind:
    """What is read from it."""
    return Kind(field.kind, field.of)


def said_kind(said: Any) -> Kind | None:
    """The kind that an annotation stands for; None: it says nothing, or nothing certain."""
    text = (
        "None" if said is None else (said if isinstance(said, str) else getattr(said, "__name__", "Any")).strip("'\"")
    )
    if text in ("Any", "") or text.startswith("tuple"):
        return None
    if text in ("None", "bool"):
        return NONE if text == "None" else BOOL
    found = field_kind(_field(text, 0))
    return found if found.kind != "ref" or found.of in LAYOUTS else None
