"""The table of addresses: steps are compiled, or their machine code is found on disk, when a floor needs them first."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from functools import partial
from importlib import import_module
from pathlib import Path
from threading import RLock

import numpy as np

from opsim.engine.fast_engine.machine.code_cache import can_link, folder, is_kept, keep, link, path_of, read, used
from opsim.engine.fast_engine.machine.compiling import WORTH_HELP, Job, Told, Work, by_numba, compiled, helped
from opsim.engine.fast_engine.machine.steps import LINES, STEPS, Step

TABLE = np.zeros(LINES, dtype=np.int64)
FIRST = ("opsim.engine.fast_engine.settle",)
"""Files whose steps take longest to compile: nobody is left waiting for them at the end."""
_ALIVE: list[object] = []
_LOCK = RLock()


def complete(
    steps: Iterable[Step],
    told: Told | None = None,
    more: Iterable[Callable[[], object]] = (),
    only_here: Iterable[Callable[[], object]] = (),
) -> None:
    """Have every one of some steps in the table; ``told(done, total)`` of those that have to be compiled.

    more : functions of modules that compile something else, to disk, and are called here or in another process
    only_here : what no other process knows of, and is called in this one, first
    """
    with _LOCK:
        new = _linked(sorted((one for one in steps if not TABLE[one.line]), key=_place_in_order))
        jobs = [*(Job("", one) for one in only_here), *(Job(_name(one), partial(_put, one)) for one in new)]
        jobs += [Job(f"{one.__module__}:{one.__qualname__}", one) for one in more]
        if jobs:
            shared = len(jobs) >= WORTH_HELP and folder() is not None
            work = Work(jobs)
            with no_garbage_looked_for(), helped(work, ["-m", __name__]) if shared else nullcontext():
                _work_off(work, len(jobs), told)
            for one in _linked([one for one in new if not TABLE[one.line]]):
                _put(one)  # was done elsewhere, and could not be kept


def _place_in_order(one: Step) -> tuple[bool, str, int]:
    """File by file."""
    return one.function.__module__ not in FIRST, one.function.__module__, one.line


def _name(one: Step) -> str:
    return f"{one.function.__module__}:{one.line}"


def _work_off(work: Work, total: int, told: Told | None) -> None:
    told = told or (lambda _done, _total: None)
    while (job := work.first()) is not None:
        told(total - work.n_open - 1, total)
        job.here()
    told(total, total)


@contextmanager
def no_garbage_looked_for() -> Iterator[None]:
    """While it is compiled all is kept by somebody: to look through it again and again took a tenth of the time."""
    before = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if before:
            gc.enable()


def _linked(lacking: Sequence[Step]) -> list[Step]:
    """Put into the table what is kept on disk, all at once. What is left."""
    found = {one: code for one in lacking if (code := read(_path(one))) is not None and can_link(code)}
    if found:
        used(_path(lacking[0]))
        for one, at in zip(found, link(found.values()), strict=True):
            TABLE[one.line] = at
    return [one for one in lacking if one not in found]


def _put(one: Step) -> None:
    """Have a step in the table: from disk, where another process has compiled it meanwhile."""
    if _linked([one]):
        TABLE[one.line] = _made(one)


def _made(one: Step) -> int:
    """Compile a step, and keep it. Its address."""
    made = compiled(one.signature, one.function)
    if made.code is not None and not can_link(made.code):
        made = by_numba(one.signature, one.function)
    if made.code is None:
        _ALIVE.append(made.alive)
        return made.at
    keep(_path(one), made.code)
    return link([made.code])[0]


def _path(one: Step) -> Path | None:
    return path_of(one.function, one.line)


def lacking(steps: Iterable[Step]) -> Iterator[Step]:
    """Those of some steps that would have to be compiled."""
    return (one for one in steps if not (TABLE[one.line] or is_on_disk(one)))


def is_on_disk(one: Step) -> bool:
    """Whether the machine code of a step is kept."""
    return is_kept(_path(one))


def help_out(names: Iterable[str]) -> None:
    """In another process: do each job that is named, to disk, and say so by a line."""
    print(flush=True)
    with no_garbage_looked_for():
        for name in names:
            do_elsewhere(name.strip())
            print(flush=True)


def do_elsewhere(name: str) -> None:
    """A step ``module:line`` that is not on disk yet, or a function ``module:name``."""
    module, _, what = name.rpartition(":")
    found = import_module(module)
    if not what.isdigit():
        getattr(found, what)()
    elif not is_on_disk(one := STEPS[int(what)]):
        made = compiled(one.signature, one.function)
        if made.code is not None and can_link(made.code):
            keep(_path(one), made.code)


if __name__ == "__main__":
    help_out(sys.stdin)
