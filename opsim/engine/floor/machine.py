"""What the rules of the floor are written in, where CPython runs them: structs are objects with slots, lists are lists,
and the line of a step is the function itself.

The compiled engine has the same names over raw memory, see ``fast_engine.machine``. With ``OPSIM_SANITIZE=1`` some of
them look at what they are given, see ``opsim.engine.sanitizer``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from os import environ
from typing import Any, TypeVar

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


def pop_first(items: list[Any]) -> Any:
    """Take the first item out. There must be one."""
    return items.pop(0)


def drop_at(items: list[Any], at: int) -> None:
    """Take the item number ``at`` out."""
    del items[at]


def index_of(items: list[Any], item: Any) -> int:
    """The number of the first that is the item; -1: none is."""
    return items.index(item) if item in items else -1


def has(items: list[Any], item: Any) -> bool:
    """Whether one of them is the item."""
    return item in items


def drop(items: list[Any], item: Any) -> bool:
    """Take the first that is the item out; whether there was one."""
    if item in items:
        items.remove(item)
        return True
    return False


def give_items_back(_floor: Any, items: list[Any]) -> None:
    """Take all items out: before the struct with the list in it is given back."""
    items.clear()


def new_ints(_floor: Any, n: int) -> list[int]:
    """An array of n whole numbers."""
    return [0] * n


def new_floats(_floor: Any, n: int) -> list[float]:
    """An array of n floats."""
    return [0.0] * n


def give_ints_back(_floor: Any, _items: list[int], _n: int) -> None:
    """An array of n that nobody refers to any more."""


class _Part:
    """What stands in an array from one on."""

    __slots__ = ("_first", "_items")

    def __init__(self, items: list[int], first: int):
        self._items, self._first = items, first

    def __getitem__(self, item: int) -> int:
        return self._items[self._first + item]


def part_of(items: list[int], first: int) -> Any:
    """What stands in an array of whole numbers from one on."""
    return _Part(items, first)


F = TypeVar("F")


def step(function: F) -> F:
    """A function of the floor and of more."""
    return function


here = line_of = step


def inlined(function: Any) -> Any:
    """A small function; of a model's method, one that asks the model at hand, which may be anybody's."""
    owner, _, name = function.__qualname__.rpartition(".")
    if not owner or owner.endswith("<locals>"):
        return function
    return lambda model, *given: getattr(model, name)(*given)


@dataclass(frozen=True)
class Step:
    """line : the function."""

    line: Any


def step_of(call: Any) -> Step:
    """What stands behind a name that is called as a step."""
    return Step(call)


def call_out(function: Any, one: Any, other: Any) -> Any:
    """Ask Python."""
    return function(one, other)


_KEEPERS: dict[type, tuple[Callable[[Any], tuple[Any, ...]], Callable[[Any, tuple[Any, ...]], None]]] = {}
"""By struct, what reads all fields, and what writes them again."""


class Arena:
    """``freeze`` keeps what was set up; ``restore`` has it again, the same objects, for the next run."""

    memory = None

    def __init__(self) -> None:
        self._structs: list[Any] = []
        self._arrays: list[list[Any]] = []
        self._frozen: tuple[list[Any], list[Any]] = [], []

    def new(self, struct: str) -> Any:
        """A struct, all of it 0."""
        made = STRUCTS[struct]()
        self._structs.append(made)
        return made

    def array(self, of: str, values: Iterable[Any]) -> list[Any]:
        """An array of numbers or structs."""
        items = [float(value) for value in values] if of == "float" else list(values)
        self._arrays.append(items)
        return items

    def freeze(self) -> None:
        """Keep all that was set up."""
        structs = []
        for one in self._structs:
            reads, writes = _keeper(type(one))
            lists = [(items, items[:]) for items in map(partial(getattr, one), lists_of(type(one)))]
            structs.append((writes, one, reads(one), lists))
        arrays = [(items, items[:]) for items in self._arrays]
        self._frozen = structs, arrays

    def restore(self) -> None:
        """All as it was when it was frozen."""
        structs, arrays = self._frozen
        for writes, one, values, lists in structs:
            writes(one, values)
            for items, kept in lists:
                items[:] = kept
        for items, kept in arrays:
            items[:] = kept


def _keeper(cls: type) -> Any:
    if cls not in _KEEPERS:
        names = tuple(fields_of(cls))
        one = len(names) == 1
        reads: Any = attrgetter(*names) if not one else (lambda struct, of=attrgetter(names[0]): (of(struct),))
        _KEEPERS[cls] = reads, written("writes", "one, values", [f"{''.join(f'one.{n}, ' for n in names)}= values"])
    return _KEEPERS[cls]


if environ.get("OPSIM_SANITIZE", "0") not in ("", "0"):
    from opsim.engine import sanitizer

    globals().update(sanitizer.names(globals()))
