"""Structs: classes of annotations as objects with slots; at first all fields are 0, nothing, or an empty list."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

NOTHING: Any = None
List = list
"""Of items inside a struct that come and go."""
Array = list
"""Of as many items as there are."""
Call = Any
"""Of a hook: what it calls."""
Handle = Any
"""A struct as those who set a floor up have it: in Python there is no other form of it."""
_LIST = re.compile(r"List\[")
_EMPTY = {"float": "0.0", "int": "0", "bool": "0"}
STRUCTS: dict[str, type] = {}
"""By the names by which they are asked for."""


def struct(cls: Any) -> Any:
    """A class of annotations as one with slots. Raises ValueError for a name taken."""
    if cls.__name__ in STRUCTS:
        raise ValueError(f"two structs are called {cls.__name__}")
    fields = {name: str(kind) for name, kind in cls.__annotations__.items()}
    sets = [f"self.{n} = {'[]' if _LIST.match(kind) else _EMPTY.get(kind, 'None')}" for n, kind in fields.items()]
    body = {"__doc__": cls.__doc__, "__module__": cls.__module__, "__slots__": tuple(fields)}
    body["__init__"] = written("__init__", "self", sets)
    body["lists"] = tuple(name for name, kind in fields.items() if _LIST.match(kind))
    made = STRUCTS[cls.__name__] = type(cls.__name__, (), body)
    return made


def more_of(name: str) -> Callable[[Any], Any]:
    """A class of a struct with more to it, which stands for it from now on: what only SimPy needs."""

    def stands_for(cls: Any) -> Any:
        assert issubclass(cls, STRUCTS[name]), (cls, name)
        STRUCTS[name] = cls
        return cls

    return stands_for


def written(name: str, arguments: str, lines: list[str]) -> Any:
    """A function of some lines."""
    space: dict[str, Any] = {}
    exec(f"def {name}({arguments}):\n " + "\n ".join(lines or ["pass"]), space)
    return space[name]


def fields_of(cls: type) -> Sequence[str]:
    """The slots that a struct has by its annotations."""
    return _described(cls).__slots__


def lists_of(cls: type) -> tuple[str, ...]:
    """Those of them that are lists."""
    return _described(cls).lists


def _described(cls: type) -> Any:
    """The class of annotations, where another one stands for it."""
    return next(one for one in cls.__mro__ if "lists" in vars(one))


def cast(_struct: Any) -> Any:
    """What takes anything for a struct: in Python it is one."""
    return _same


def _same(one: Any) -> Any:
    return one


def address_of(one: Any) -> Any:
    """What Python is given where it is asked about something: the thing itself."""
    return one


def fresh(struct_of: Any) -> Callable[[Any], Any]:
    """A function of the floor that gives a new struct."""
    return lambda _floor: struct_of()


def give_back(_struct: Any) -> Callable[[Any, Any], None]:
    """A function of the floor and a struct that nobody refers to any more: Python finds that out by itself."""
    return _forget


def _forget(_floor: Any, _one: Any) -> None:
    pass
