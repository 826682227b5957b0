"""How numba compiles what the engine is made of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numba
from numba import extending
from numba.core.errors import NumbaError

from opsim.engine.fast_engine.machine.slow import say
from opsim.engine.fast_engine.machine.store import Code

F = TypeVar("F", bound=Callable)
intrinsic: Any = extending.intrinsic
NO_WRAPPERS: dict[str, Any] = {"nogil": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Nobody calls these from Python, so nothing is made for that."""


OTHER_NUMBA = "compiled as numba does it by itself, which takes longer: it may be another numba than is known here"
FAILURES = (NumbaError, RuntimeError, AttributeError, TypeError, LookupError, ValueError, AssertionError)
"""NOTE: what comes of inner parts that are others than they were. What is wrong with a function is raised the second
time too; and a full memory, or an interruption, is nothing to go on after."""


def _compiler() -> Any:
    """numba's compiler with less around it; None where this numba is another one than it was written for."""
    try:
        from opsim.engine.fast_engine.machine import compiler
    except (ImportError, AttributeError) as error:
        say("the fast engine", OTHER_NUMBA, error)
        return None
    return compiler


LESS = _compiler()


def inlined(function: F) -> F:
    """A small function that is compiled into each step that calls it. It may not call itself, in no way round.

    Used in another file, it belongs into ``parts/`` or ``machine/``: see ``stamp``.
    """
    made: F = _helper(function)
    return made


def forced(function: F) -> F:
    """As ``inlined``, and put into its callers however long it is."""
    made: F = _helper(function, forceinline=True)
    return made


def _helper(function: Callable, **options: bool) -> Any:
    if LESS is not None:
        try:
            return LESS.helper(**options)(function)
        except (TypeError, AttributeError) as error:
            say(function.__qualname__, OTHER_NUMBA, error)
    wanted: dict[str, Any] = {**NO_WRAPPERS, **options}
    return numba.njit(**wanted)(function)


class Compiled(NamedTuple):
    """Either the machine code of a function; or at : its address, alive : what its machine code lives with"""

    code: Code | None = None
    at: int = 0
    alive: object = None


def compiled(signature: Any, function: Callable) -> Compiled:
    """A function compiled for one signature: as shortly as can be, and else as numba does it by itself."""
    if LESS is None:
        return by_numba(signature, function)
    try:
        return Compiled(LESS.compiled_step(signature, function))
    except FAILURES as error:
        made = by_numba(signature, function)
        say(function.__qualname__, OTHER_NUMBA, error)
        return made


def by_numba(signature: Any, function: Callable) -> Compiled:
    """The same by what numba offers to everybody; it keeps the machine code in files of its own."""
    made, known_by = kept(signature, function), tuple(signature.args)
    if known_by not in made.overloads:  # another source's: numba's files are mixed up where two versions save at once
        made = numba.njit(signature, **NO_WRAPPERS)(function)
    result = made.overloads[known_by]
    return Compiled(at=int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name)), alive=made)


def kept(signature: Any, function: Callable) -> Any:
    """A function compiled for one signature, its machine code kept on disk, or not where nothing can be written."""
    try:
        return numba.njit(signature, cache=True, **NO_WRAPPERS)(function)
    except RuntimeError as error:  # numba: "cannot cache function ...: no locator available"
        if "locator" not in str(error):
            raise
        return numba.njit(signature, **NO_WRAPPERS)(function)
