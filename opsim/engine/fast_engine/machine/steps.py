"""Steps: functions that are compiled each by itself and call each other by way of a table of addresses.

So steps may call each other in any way round, each is compiled once, and a floor needs only those that it can come to.
A step's first argument is the floor, whose first field leads to the table. Which line of the table a step has follows
from its name and its signature, so that machine code kept on disk finds it again.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from hashlib import blake2b
from typing import Any, TypeVar

from llvmlite import ir
from numba.core import cgutils, types

from opsim.engine.fast_engine.machine.code_cache import stamp_of
from opsim.engine.fast_engine.machine.compiling import forced, intrinsic
from opsim.engine.fast_engine.machine.structs import POINTER, at_byte, type_of

F = TypeVar("F", bound=Callable)
LINES = 1 << 20
"""Of the table. Two steps of one line are refused: one of them needs another name."""


@dataclass(frozen=True, eq=False)
class Step:
    """function : as it is written; line : of the table; signature : compiled types of its arguments and its answer."""

    function: Callable
    line: int
    signature: Any

    @property
    def name(self) -> str:
        return f"{self.function.__module__.rpartition('.')[2]}.{self.function.__name__}"


STEPS: dict[int, Step] = {}
"""All steps by their lines."""
_OF_CALLABLE: dict[int, Step] = {}


def step(function: F) -> F:
    """A function of the floor and of more, all annotated; it answers nothing, a number, or a reference."""
    said = {name: str(kind).strip("'\"") for name, kind in function.__annotations__.items()}
    answer = said.pop("return", "None")
    arguments = tuple(type_of(kind) for kind in said.values())
    signature = (types.none if answer == "None" else type_of(answer))(*arguments)
    told = f"{function.__module__}.{function.__qualname__}({','.join(said.values())})->{answer}"
    line = int.from_bytes(blake2b(told.encode(), digest_size=4).digest(), "little") % LINES
    if line in STEPS and _name_of(STEPS[line].function) != _name_of(function):
        raise ValueError(f"{told} and {STEPS[line].name} share a line of the table: rename one of them")
    stamp_of(function.__code__.co_filename)  # now: the file may be another one when the step is compiled
    made = STEPS[line] = Step(function, line, signature)
    call = _by_table(function, line, signature)
    _OF_CALLABLE[id(call)] = made
    return call


def _name_of(function: Callable) -> tuple[str, str]:
    return function.__module__, function.__qualname__


def step_of(call: Any) -> Step:
    """What stands behind a name that is called as a step."""
    return _OF_CALLABLE[id(call)]


class Line(int):
    """A number of a line. NOTE: where a step names one, it needs that step."""


Call = Line
"""Of a hook: what it calls."""


def line_of(call: Any) -> Line:
    """Its line of the table: what hooks and events say for what is to be done."""
    return Line(step_of(call).line)


def here(call: F) -> F:
    """The function of a step, to be compiled into the step that calls it: faster, where that happens all the time."""
    made: Any = forced(step_of(call).function)
    return made


def needed(roots: Iterable[Step]) -> Iterator[Step]:
    """The steps that can be come to from some, themselves included: those that each names in its code."""
    todo, seen = list(roots), set[int]()
    while todo:
        one = todo.pop()
        if one.line not in seen:
            seen.add(one.line)
            yield one
            todo += _named_in(one.function, set())


def _named_in(function: Callable, seen: set[int]) -> Iterator[Step]:
    """The steps that a function names, and those that the compiled functions that it names do."""
    for value in _values(function):
        if isinstance(value, Line):
            yield STEPS[value]
        elif id(value) in _OF_CALLABLE:
            yield _OF_CALLABLE[id(value)]
        elif hasattr(value, "py_func") and id(value) not in seen:
            seen.add(id(value))
            yield from _named_in(value.py_func, seen)


def _values(function: Callable) -> Iterator[Any]:
    """What the names in a function's code stand for, where they are known; as in ``line.stop`` too."""
    known = inspect.getclosurevars(function)
    yield from known.nonlocals.values()
    for value in known.globals.values():
        yield value
        if inspect.ismodule(value):
            yield from (getattr(value, name) for name in function.__code__.co_names if hasattr(value, name))


def _call(builder: Any, context: Any, line: Any, answer: Any, arguments: Any, values: Any) -> Any:
    """Call what a line of the table leads to; an exception there is one here."""
    table = builder.load(at_byte(builder, values[0], 0, POINTER))
    kind = context.call_conv.get_function_type(answer, arguments)
    lines = builder.bitcast(table, kind.as_pointer().as_pointer())
    function = builder.load(builder.gep(lines, [line], inbounds=True))
    status, result = context.call_conv.call_function(builder, function, answer, arguments, values)
    with cgutils.if_unlikely(builder, status.is_error):
        context.call_conv.return_status_propagate(builder, status)
    return context.get_dummy_value() if answer == types.none else result


def _sign(call: Any, parameters: list[inspect.Parameter]) -> None:
    """numba reads from its signature what a call may be given."""
    call.__signature__ = inspect.Signature(parameters)


def _by_table(function: Callable, line: int, signature: Any) -> Any:
    def call(_typingctx: Any, *_args: Any) -> Any:
        def codegen(context: Any, builder: Any, _sig: Any, values: Any) -> Any:
            where = ir.Constant(ir.IntType(64), line)
            return _call(builder, context, where, signature.return_type, signature.args, values)

        return signature, codegen

    given = list(inspect.signature(function).parameters.values())
    first = inspect.Parameter("_typingctx", inspect.Parameter.POSITIONAL_OR_KEYWORD)
    _sign(call, [first, *given])
    call.__name__ = function.__name__
    return intrinsic(call)


def _hook(answer: Any, n_arguments: int) -> Any:
    """A call of a line that is known only when it happens, with the floor and so many references or numbers."""
    names = ["_typingctx", "line", "floor", *(f"argument_{i}" for i in range(n_arguments))]

    def call(_typingctx: Any, *args: Any) -> Any:
        def codegen(context: Any, builder: Any, sig: Any, values: Any) -> Any:
            return _call(builder, context, values[0], answer, sig.args[1:], values[1:])

        return answer(types.int64, *args[1:]), codegen

    parameters = [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD) for name in names]
    _sign(call, parameters)
    return intrinsic(call)


ask_1, ask_2, ask_3 = (_hook(types.int64, n) for n in (1, 2, 3))
"""``ask_2(line, floor, subject, job)``: the number, or truth, that a hook answers."""
tell_0, tell_1, tell_2, tell_3 = (_hook(types.none, n) for n in range(4))
"""The same for hooks that answer nothing."""

__all__ = [
    *("LINES", "STEPS", "Step", "ask_1", "ask_2", "ask_3", "here", "line_of", "needed", "step", "step_of"),
    *("tell_0", "tell_1", "tell_2", "tell_3"),
]
