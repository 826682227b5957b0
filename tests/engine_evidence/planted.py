"""Faults planted into the compiled engine of a process of its own: the source of one function, some words replaced.

Steps into whose machine code the function goes are compiled anew, in memory alone; all others are the sound ones from
disk. So no machine code of a sound engine stands in for a faulty one, nor the other way round.
"""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any

from opsim.plan import Plan

FAST = "opsim.engine.fast_engine"
_KEPT: list[Any] = []


def plant(place: str, old: str, new: str) -> Callable:
    """The function of a ``file.name``, with other words from now on, for whoever compiles it. Raises ValueError."""
    module_name, _, name = place.rpartition(".")
    module = import_module(f"{FAST}.{module_name}")
    function = _written(getattr(module, name))
    lines = textwrap.dedent(inspect.getsource(function)).splitlines(keepends=True)
    text = "".join(lines[next(i for i, line in enumerate(lines) if line.startswith("def ")) :])
    if text.count(old) != 1:
        raise ValueError(f"{place} has {text.count(old)} times {old!r}: the fault has to be written anew")
    known: dict[str, Any] = {}
    exec(_code(text.replace(old, new), place), vars(module), known)
    function.__code__ = known[name].__code__
    return function


def _code(text: str, place: str) -> Any:
    """A function as it stands in a rule of the floor, or in the engine itself: the latter stays as it is."""
    from opsim.engine.fast_engine.lowering import lowered

    tree = lowered(f"from __future__ import annotations\n@step\n{text}", place)
    tree.body[-1].decorator_list = []  # type: ignore[attr-defined]
    return compile(tree, place, "exec")


def make_ready(plan: Plan, faulty: Callable) -> int:
    """Have the steps of a plan in the table, those with a faulty function in them compiled; how many these are.

    Raises RuntimeError where a sound step is not on disk: ``fast_engine.ready`` of a process without faults puts it.
    """
    from opsim.engine.fast_engine.machine import TABLE, needed
    from opsim.engine.fast_engine.machine.table import is_on_disk
    from opsim.engine.fast_engine.run import built

    touched = 0
    for one in needed(built(plan).steps.values()):
        has_it = any(function is faulty for function in _within(one.function, set()))
        touched += has_it
        if not TABLE[one.line] and has_it:
            TABLE[one.line] = _compiled(one)
        elif not TABLE[one.line] and not is_on_disk(one):
            raise RuntimeError(f"{one.name} is not on disk")
    return touched


def _compiled(one: Any) -> int:
    """The address of the machine code of a step that nobody keeps."""
    import numba

    from opsim.engine.fast_engine.machine.compiling import NO_WRAPPERS

    compiled = numba.njit(one.signature, **NO_WRAPPERS)(one.function)
    _KEPT.append(compiled)
    result = compiled.overloads[tuple(one.signature.args)]
    return int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name))


def _within(function: Callable, seen: set[int]) -> Iterator[Callable]:
    """A function, and all that are compiled into it."""
    from opsim.engine.fast_engine.machine.steps import _values

    if id(function) not in seen:
        seen.add(id(function))
        yield function
        for value in _values(function):
            if hasattr(value, "py_func"):
                yield from _within(value.py_func, seen)


def _written(value: Any) -> Callable:
    """The Python function behind a step, or behind what is compiled into steps."""
    from opsim.engine.fast_engine.machine import step_of

    return value.py_func if hasattr(value, "py_func") else step_of(value).function
