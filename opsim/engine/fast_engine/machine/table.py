"""The table of addresses: steps are compiled, or their machine code is found on disk, when a floor needs them first."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from pathlib import Path
from threading import RLock

import numpy as np

from opsim.engine.fast_engine.machine.compiling import Compiled, compiled
from opsim.engine.fast_engine.machine.linking import can_link, link
from opsim.engine.fast_engine.machine.steps import LINES, STEPS, Step
from opsim.engine.fast_engine.machine.store import folder, is_kept, keep, path_of, read, used

TABLE = np.zeros(LINES, dtype=np.int64)
WORTH_HELP = 16
"""So many steps to compile are worth other processes: each takes 0.1 to 0.2 s, and a process 0.7 s to begin."""
_ALIVE: list[object] = []
_LOCK = RLock()
Told = Callable[[int, int], None]


def complete(steps: Iterable[Step], told: Told | None = None) -> None:
    """Have every one of some steps in the table; ``told(done, total)`` of those that have to be compiled."""
    with _LOCK:
        lacking = sorted((one for one in steps if not TABLE[one.line]), key=lambda one: one.line)
        new = _linked(lacking)
        helpers = _helpers(new) if len(new) >= WORTH_HELP else []
        try:
            _compile(new, told)
        finally:
            for helper in helpers:
                helper.kill()
                helper.wait()


def _linked(lacking: Sequence[Step]) -> list[Step]:
    """Put into the table what is kept on disk, all at once. What is left."""
    found = {one: code for one in lacking if (code := read(_path(one))) is not None and can_link(code)}
    if found:
        used(_path(lacking[0]))
        for one, at in zip(found, link(found.values()), strict=True):
            TABLE[one.line] = at
    return [one for one in lacking if one not in found]


def _compile(new: Sequence[Step], told: Told | None) -> None:
    for done, one in enumerate(new):
        if told is not None:
            told(done, len(new))
        if _linked([one]):  # another process has not compiled it meanwhile
            made = compiled(one.signature, one.function)
            _keep(one, made)
            _ALIVE.append(made.alive)
            TABLE[one.line] = made.at
    if new and told is not None:
        told(len(new), len(new))


def _keep(one: Step, made: Compiled) -> None:
    if made.code is not None and can_link(made.code):
        keep(_path(one), made.code)


def _path(one: Step) -> Path | None:
    return path_of(one.function, one.line)


def is_complete(steps: Iterable[Step]) -> bool:
    """Whether nothing of some steps would have to be compiled."""
    return all(TABLE[one.line] or is_on_disk(one) for one in steps)


def is_on_disk(one: Step) -> bool:
    """Whether the machine code of a step is kept."""
    return is_kept(_path(one))


def _helpers(new: Sequence[Step]) -> list[subprocess.Popen]:
    """Processes that compile the same steps in another order, to disk: each finds what the others have done.

    None where there is one processor, or no place on disk.
    """
    n_helpers = min(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1, 4) - 1
    if n_helpers < 1 or folder() is None:
        return []
    found = []
    for number in range(1, n_helpers + 1):
        first = len(new) * number // (n_helpers + 1)
        order = [*reversed(new[first:]), *reversed(new[:first])] if n_helpers == 1 else [*new[first:], *new[:first]]
        command = [sys.executable, "-m", __name__, *(f"{one.function.__module__}:{one.line}" for one in order)]
        found.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
    return found


def compile_some(names: Iterable[str]) -> None:
    """Compile the steps ``module:line`` that are not on disk yet."""
    for module, _, line in (name.rpartition(":") for name in names):
        import_module(module)
        one = STEPS[int(line)]
        if not is_on_disk(one):
            _keep(one, compiled(one.signature, one.function))


if __name__ == "__main__":
    from opsim.engine.fast_engine.machine.table import compile_some as compile_them

    compile_them(sys.argv[1:])
