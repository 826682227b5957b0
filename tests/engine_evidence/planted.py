"""Faults planted into the engines of a process of its own: the source of one function, some words replaced.

A rule of the floor has one source, which two drivers read: SimPy's (``SIMPY``) and the compiled one (``FAST``).
A process with a fault compiles all steps that a floor needs, in memory alone. So no machine code of a sound engine
stands in for a faulty one, nor the other way round.
"""

from __future__ import annotations

import ast
import inspect
import os
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

from pytest import MonkeyPatch

import opsim
from opsim.engine.fast_engine.lowering import written
from opsim.engine.fast_engine.machine import code_cache, table
from opsim.engine.fast_engine.machine.code_cache import source_of
from opsim.engine.fast_engine.machine.compiler import Module
from opsim.engine.fast_engine.run import built
from opsim.plan import Plan

FAST, SIMPY = "opsim.engine.fast_engine", "SimPy"


def plant(place: str, old: str, new: str) -> Callable:
    """The function of a ``file.name``, with other words from now on, for whoever compiles it. Raises ValueError."""
    module, function, text = _with_words(FAST, place, old, new)
    known: dict[str, Any] = {}
    with NamedTemporaryFile("w", suffix=".py", delete=False) as file:  # what is compiled is read from its file
        file.write(f"from __future__ import annotations\n{text}")
    exec(compile(Path(file.name).read_text(), file.name, "exec"), vars(module), known)
    function.__code__ = known[function.__name__].__code__
    source_of(file.name)
    os.unlink(file.name)
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
    module = import_module(f"{FAST}.{module_name}" if package == FAST else _in_python(module_name))
    function = _written(getattr(module, name)) if package == FAST else getattr(module, name)
    lines = textwrap.dedent(inspect.getsource(function)).splitlines(keepends=True)
    text = "".join(lines[_line_of(function) - function.__code__.co_firstlineno :])
    if text.count(old) != 1:
        raise ValueError(f"{place} has {text.count(old)} times {old!r}: the fault has to be written anew")
    return module, function, text.replace(old, new)


def _in_python(rule: str) -> str:
    """The module in which a rule is written, by its name alone."""
    path = written()[rule].relative_to(Path(opsim.__file__).parents[1])
    return ".".join(path.with_suffix("").parts)


def _line_of(function: Any) -> int:
    """The line in which a function begins, below its decorators."""
    lines, first = inspect.getsourcelines(function)
    return first + next(i for i, line in enumerate(lines) if line.lstrip().startswith("def "))


def make_ready(plan: Plan, faulty: Callable) -> bool:
    """Have the steps of a plan in the table, compiled after the fault was planted; whether the function is in them."""
    steps = built(plan).steps.values()
    with MonkeyPatch.context() as alone:
        alone.setattr(code_cache, "kept", list)
        alone.setattr(code_cache, "keep", lambda _code: False)
        table.complete(steps)
    return faulty in Module(steps, lambda _line: False).functions


def _written(value: Any) -> Callable:
    """The Python function behind a step, or behind what is compiled into steps."""
    return value.function
