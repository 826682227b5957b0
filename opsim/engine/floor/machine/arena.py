"""What a floor is set up in: all that is there before its first instant is known, and had again for the next run."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from operator import attrgetter
from typing import Any

from opsim.engine.floor.machine.structs import STRUCTS, fields_of, lists_of, written

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
