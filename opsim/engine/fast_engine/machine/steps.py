"""Steps: functions that are compiled together, and that hooks and events call by way of a table of addresses.

A step's first argument is the floor, whose first field leads to the table. Which line of the table a step has follows
from its name and its signature.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import Any, TypeVar

from opsim.engine.fast_engine.machine.compiler import Helper
from opsim.engine.fast_engine.machine.structs import BOOL, INT, NONE, Kind, said_kind

F = TypeVar("F", bound=Callable)
LINES = 1 << 20
"""Of the table. Two steps of one line are refused: one of them needs another name."""
ANYTHING = Kind("ref", "Any")


@dataclass(frozen=True, eq=False)
class Step:
    """function : as it is written; line : of the table."""

    function: Callable
    line: int

    def __call__(self, *given: Any) -> Any:
        raise TypeError(f"{self.name} is compiled, and not called from Python")

    @property
    def name(self) -> str:
        return f"{self.function.__module__.rpartition('.')[2]}.{self.function.__name__}"

    @property
    def symbol(self) -> str:
        return f"@step_{self.line}"

    @cached_property
    def kinds(self) -> tuple[Kind, ...]:
        said = [one for name, one in self.function.__annotations__.items() if name != "return"]
        return tuple(INT if (kind := said_kind(one)) == BOOL else kind or ANYTHING for one in said)

    @cached_property
    def answer(self) -> Kind:
        """NOTE: a truth is a number, as who calls by the table does not know which of them it is."""
        kind = said_kind(self.function.__annotations__.get("return", "None"))
        return INT if kind == BOOL else kind or ANYTHING


STEPS: dict[int, Step] = {}
"""All steps by their lines."""


def step(function: F) -> F:
    """A function of the floor and of more, all annotated; it answers nothing, a number, or a reference."""
    said = [str(kind).strip("'\"") for kind in function.__annotations__.values()]
    told = f"{function.__module__}.{function.__qualname__}({','.join(said)})"
    line = int.from_bytes(blake2b(told.encode(), digest_size=4).digest(), "little") % LINES
    if line in STEPS and _name_of(STEPS[line].function) != _name_of(function):
        raise ValueError(f"{told} and {STEPS[line].name} share a line of the table: rename one of them")
    made: Any = Step(function, line)
    STEPS[line] = made
    return made


def _name_of(function: Callable) -> tuple[str, str]:
    return function.__module__, function.__qualname__


def step_of(call: Any) -> Any:
    """What stands behind a name that is called as a step; None: it is none."""
    return call if isinstance(call, Step) else None


Call = int
"""Of a hook: what it calls."""


def line_of(call: Any) -> int:
    """Its line of the table: what hooks and events say for what is to be done."""
    return int(call.line)


def here(call: F) -> F:
    """The function of a step, to be compiled into the step that calls it: faster, where that happens all the time."""
    made: Any = Helper(step_of(call).function, "alwaysinline")
    return made
