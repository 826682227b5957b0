"""How numba compiles what the engine is made of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba import extending

F = TypeVar("F", bound=Callable)
intrinsic: Any = extending.intrinsic
NO_WRAPPERS: dict[str, Any] = {"nogil": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Nobody calls these from Python, so nothing is made for that."""


def inlined(function: F) -> F:
    """A small function that is compiled into each step that calls it. It may not call itself, in no way round.

    Used in another file, it belongs into ``parts/`` or ``machine/``: see ``stamp``.
    """
    made: Any = numba.njit(**NO_WRAPPERS)(function)
    return made


def forced(function: F) -> F:
    """As ``inlined``, and put into its callers however long it is."""
    made: Any = numba.njit(forceinline=True, **NO_WRAPPERS)(function)
    return made


def kept(signature: Any, function: Callable) -> Any:
    """A function compiled for one signature, its machine code kept on disk, or not where nothing can be written."""
    try:
        return numba.njit(signature, cache=True, **NO_WRAPPERS)(function)
    except RuntimeError as error:  # numba: "cannot cache function ...: no locator available"
        if "locator" not in str(error):
            raise
        return numba.njit(signature, **NO_WRAPPERS)(function)


def entered(function: F) -> F:
    """A function that Python calls, kept on disk where that can be."""
    try:
        made: Any = numba.njit(cache=True, nogil=True)(function)
    except RuntimeError as error:
        if "locator" not in str(error):
            raise
        made = numba.njit(nogil=True)(function)
    return made
