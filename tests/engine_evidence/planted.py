"""Faults planted into the engines of a process of its own: the source of one function, some words replaced.

A rule of the floor has one source, which two drivers read: SimPy's (``SIMPY``) and the compiled one (``FAST``).
Steps into whose machine code the function goes are compiled anew, in memory alone; all others are the sound ones from
disk. So no machine code of a sound engine stands in for a faulty one, nor the other way round.
"""

from __future__ import annotations

import ast
import inspect
import os
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from opsim.plan import Plan

FAST, SIMPY = "opsim.engine.fast_engine", "opsim.engine.floor"
_KEPT: list[Any] = []


def plant(place: str, old: str, new: str) -> Callable:
    """The function of a ``file.name``, with other words from now on, for whoever compiles it. Raises ValueError."""
    module, function, text = _with_words(FAST, place, old, new)
    known: dict[str, Any] = {}
    exec(_code(text, place), vars(module), known)
    function.__code__ = known[function.__name__].__code__
    return function


@contextmanager
def planted_in_simpy(place: str, old: str, new: str) -> Iterator[None]:
    """The same for SimPy's driver, for a while; looked at where ``OPSIM_SANITIZE`` says so."""
    module, function, text = _with_words(SIMPY, place, old, new)
    before, known = function.__code__, {}
    tree = ast.parse(f"from __future__ import annotations\n{text}")
    ast.increment_lineno(tree.body[1], _line_of(function) - 2)
    try:
        if is_sanitized():
            from opsim.engine.sanitizer import watch

            watch(function, tree.body[1])
        else:
            exec(compile(tree, before.co_filename, "exec"), vars(module), known)
            function.__code__ = known[function.__name__].__code__
        yield
    finally:
        function.__code__ = before


def is_sanitized() -> bool:
    """Whether SimPy's driver refuses here what compiled code does not see."""
    return os.environ.get("OPSIM_SANITIZE", "0") not in ("", "0")


def _with_words(package: str, place: str, old: str, new: str) -> tuple[Any, Any, str]:
    """The module of a ``file.name`` in a package, its function, and the text of it with other words."""
    module_name, _, name = place.rpartition(".")
    module = import_module(f"{package}.{module_name}")
    function = _written(getattr(module, name)) if package == FAST else getattr(module, name)
    lines = textwrap.dedent(inspect.getsource(function)).splitlines(keepends=True)
    text = "".join(lines[_line_of(function) - function.__code__.co_firstlineno :])
    if text.count(old) != 1:
        raise ValueError(f"{place} has {text.count(old)} times {old!r}: the fault has to be written anew")
    return module, function, text.replace(old, new)


def _line_of(function: Any) -> int:
    """The line in which a function begins, below its decorators."""
    lines, first = inspect.getsourcelines(function)
    return first + next(i for i, line in enumerate(lines) if line.lstrip().startswith("def "))


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
