"""The table of addresses: steps are compiled, or their machine code is found on disk, when a floor needs them first."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from threading import RLock
from typing import Any

import numba
import numpy as np

from opsim.engine.fast_engine.machine.compiling import NO_WRAPPERS, kept
from opsim.engine.fast_engine.machine.steps import LINES, STEPS, Step

TABLE = np.zeros(LINES, dtype=np.int64)
WORTH_HELP = 16
"""So many steps to compile are worth other processes: each takes 0.1 to 0.2 s, and a process 0.7 s to begin."""
_KEPT: dict[int, object] = {}
_LOCK = RLock()
Told = Callable[[int, int], None]


def complete(steps: Iterable[Step], told: Told | None = None) -> None:
    """Have every one of some steps in the table; ``told(done, total)`` of those that have to be compiled."""
    with _LOCK:
        lacking = sorted((one for one in steps if not TABLE[one.line]), key=lambda one: one.line)
        new = [one for one in lacking if not is_on_disk(one)] if lacking else []
        helpers = _helpers(new) if len(new) >= WORTH_HELP else []
        try:
            _complete(lacking, new, told)
        finally:
            for helper in helpers:
                helper.kill()
                helper.wait()


def _complete(lacking: Sequence[Step], new: Sequence[Step], told: Told | None) -> None:
    for done, one in enumerate(new):
        if told is not None:
            told(done, len(new))
        _take(one)
    for one in lacking:
        _take(one)
    if new and told is not None:
        told(len(new), len(new))


def is_complete(steps: Iterable[Step]) -> bool:
    """Whether nothing of some steps would have to be compiled."""
    return all(TABLE[one.line] or is_on_disk(one) for one in steps)


def is_on_disk(one: Step) -> bool:
    """Whether numba finds the machine code of a step on disk."""
    from numba.core.caching import FunctionCache
    from numba.core.registry import cpu_target

    try:
        cache: Any = FunctionCache(one.function)
    except RuntimeError:  # no place where it could be
        return False
    key = cache._index_key(one.signature, cpu_target.target_context.codegen())
    return key in cache._cache_file._load_index()


def _take(one: Step) -> None:
    if not TABLE[one.line]:
        compiled, known_by = kept(one.signature, one.function), tuple(one.signature.args)
        if known_by not in compiled.overloads:  # another source's: numba's files are mixed up where two versions save
            compiled = numba.njit(one.signature, **NO_WRAPPERS)(one.function)
        _KEPT[one.line] = compiled  # NOTE: the machine code lives as long as this does
        result = compiled.overloads[known_by]
        TABLE[one.line] = int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name))


def _helpers(new: Sequence[Step]) -> list[subprocess.Popen]:
    """Processes that compile the same steps in another order, to disk: each finds what the others have done.

    None where there is one processor, or no place on disk.
    """
    n_helpers = min(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1, 4) - 1
    if n_helpers < 1 or not _can_keep(new[0]):
        return []
    found = []
    for number in range(1, n_helpers + 1):
        first = len(new) * number // (n_helpers + 1)
        order = [*reversed(new[first:]), *reversed(new[:first])] if n_helpers == 1 else [*new[first:], *new[:first]]
        command = [sys.executable, "-m", __name__, *(str(one.line) for one in order)]
        found.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
    return found


def _can_keep(one: Step) -> bool:
    from numba.core.caching import FunctionCache

    try:
        FunctionCache(one.function)
    except RuntimeError:
        return False
    return True


def compile_lines(lines: Iterable[int]) -> None:
    """Compile the steps of some lines that are not on disk yet."""
    import opsim.engine.fast_engine.blocks as blocks

    blocks.know_all()
    for line in lines:
        if not is_on_disk(STEPS[line]):
            kept(STEPS[line].signature, STEPS[line].function)


if __name__ == "__main__":
    from opsim.engine.fast_engine.machine.table import compile_lines as compile_them

    compile_them(int(line) for line in sys.argv[1:])
