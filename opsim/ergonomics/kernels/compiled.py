"""Compiled loops: arrays in, arrays out. Imported by the functions that need them: nobody else pays for numba.

``compiled``: numba.njit with the machine code kept on disk, or not kept where no cache can be written.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from hashlib import blake2b
from pathlib import Path
from typing import Any

import numba


def compiled(**options: Any) -> Callable[[Callable], Callable]:
    """A decorator like ``numba.njit(cache=True, **options)``; where no cache can be written it compiles anew."""

    def decorate(function: Callable) -> Callable:
        try:
            return _seeing_helpers(numba.njit(cache=True, **options)(function), function)
        except RuntimeError as error:  # numba: "cannot cache function ...: no locator available"
            if "locator" not in str(error):
                raise
            return numba.njit(**options)(function)

    return decorate


@cache
def called_from_c(function: Callable, signature: str) -> Any:
    """A function as C calls it, ``address`` is where; kept as ``compiled`` is. Its helpers are to stand in its file."""
    try:
        return numba.cfunc(signature, cache=True)(function)
    except RuntimeError as error:
        if "locator" not in str(error):
            raise
        return numba.cfunc(signature)(function)


def _seeing_helpers(made: Any, function: Callable) -> Any:
    """numba compiles anew when the file of a function changes: now too when that of one does that it calls.

    NOTE: this is an inner part of numba; where that is another one, only the file itself is seen.
    """
    file: Any = getattr(getattr(made, "_cache", None), "_cache_file", None)
    others = sorted({one.__code__.co_filename for one in _called(function, set())} - {function.__code__.co_filename})
    if others and hasattr(file, "_source_stamp"):
        file._source_stamp = (file._source_stamp, *map(_content_of, others))
    return made


def _called(function: Callable, seen: set[int]) -> Iterator[Any]:
    """The compiled functions that one names, and those that they name."""
    for name in function.__code__.co_names:
        other = getattr(function.__globals__.get(name), "py_func", None)
        if other is not None and id(other) not in seen:
            seen.add(id(other))
            yield other
            yield from _called(other, seen)


@cache
def _content_of(file: str) -> str:
    try:
        return blake2b(Path(file).read_bytes(), digest_size=16).hexdigest()
    except OSError:
        return ""
