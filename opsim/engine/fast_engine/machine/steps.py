"""Steps: functions that are compiled where a floor can come to them, and that hooks and events call by a table.

A step's first argument is the floor, whose first field leads to the table of their addresses. Which line of it a step
has follows from its name and its signature, so that machine code kept on disk finds it again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import Any, TypeVar

from opsim.engine.fast_engine.machine.code_cache import stamp_of
from opsim.engine.fast_engine.machine.intrinsics import Helper
from opsim.engine.fast_engine.machine.structs import BOOL, INT, Kind, said_kind

F = TypeVar("F", bound=Callable)
LINES = 1 << 20
"""Of the table. Two steps of one line are refused: one of them needs another name."""
ANYTHING = Kind("ref", "Any")


@dataclass(frozen=True, eq=False)
class Step:
    """function : as it is written; line : of the table."""

    function: Any
    line: int

    def __call__(self, *_: Any) -> Any:
        """Raises TypeError."""
        raise TypeError(f"{self.name} is compiled, and not called from Python")

    @property
    def name(self) -> str:
        """The file's name, and the function's."""
        return f"{self.function.__module__.rpartition('.')[2]}.{self.function.__name__}"

    @property
    def symbol(self) -> str:
        """LLVM's name for it."""
        return f"@step_{self.line}"

    @cached_property
    def kinds(self) -> tuple[Kind, ...]:
        """Of its arguments. NOTE: a truth is a number, as who calls by the table does not know which of them it is."""
        said = [one for name, one in self.function.__annotations__.items() if name != "return"]
        return tuple(map(_by_table, said))

    @cached_property
    def answer(self) -> Kind:
        """The kind of it."""
        return _by_table(self.function.__annotations__.get("return", "None"))


def _by_table(said: Any) -> Kind:
    kind = said_kind(said)
    return INT if kind == BOOL else kind or ANYTHING


STEPS: dict[int, Step] = {}
"""All steps by their lines."""


def step(function: F) -> F:
    """A function of the floor and of more, all annotated; it answers nothing, a number, or a reference.

    Raises ValueError where its line is another one's.
    """
    said = {name: str(kind).strip("'\"") for name, kind in function.__annotations__.items()}
    answer = said.pop("return", "None")
    told = f"{function.__module__}.{function.__qualname__}({','.join(said.values())})->{answer}"
    line = int.from_bytes(blake2b(told.encode(), digest_size=4).digest(), "little") % LINES
    if line in STEPS and _name_of(STEPS[line].function) != _name_of(function):
        raise ValueError(f"{told} and {STEPS[line].name} share a line of the table: rename one of them")
    stamp_of(function.__code__.co_filename)  # now: the file may be another one when the step is compiled
    made: Any = Step(function, line)
    STEPS[line] = made
    return made  # type: ignore[no-any-return]


def _name_of(function: Callable) -> tuple[str, str]:
    return function.__module__, function.__qualname__


def step_of(call: Any) -> Step:
    """What stands behind a name that is called as a step. Raises TypeError."""
    if not isinstance(call, Step):
        raise TypeError(f"{call!r} is no step")
    return call


class Line(int):
    """A number of a line. NOTE: where a step names one, it needs that step."""


Call = Line
"""Of a hook: what it calls."""


def line_of(call: Any) -> Line:
    """Its line of the table: what hooks and events say for what is to be done."""
    return Line(step_of(call).line)


def here(call: F) -> F:
    """The function of a step, to be compiled into the step that calls it: faster, where that happens all the time."""
    made: Any = Helper(step_of(call).function, "alwaysinline")
    return made  # type: ignore[no-any-return]
