"""BLAS on one thread, so that results do not depend on how many cores a machine has."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache
from typing import Any

_held: ContextVar[bool] = ContextVar("one BLAS thread is held", default=False)


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Whatever multiplies matrices inside does so on one thread.

    NOTE: finding the libraries takes 0.5 to 5 ms, a third of a short replication: they are looked for again only when
    something was imported since, and inside such a block another one does nothing. Nor is anything set where all have
    one thread anyhow, since setting takes 20 us, a hundredth of a short replication.
    """
    if _held.get():
        yield
        return
    token = _held.set(True)
    try:
        libraries = _libraries(len(sys.modules))
        if all(one.num_threads == 1 for one in libraries.lib_controllers):
            yield
        else:
            with libraries.limit(limits=1):
                yield
    finally:
        _held.reset(token)


@lru_cache(maxsize=1)
def _libraries(_n_modules: int) -> Any:
    """Those of BLAS that are loaded; ``_n_modules`` : imported so far, since a library comes with one."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(user_api="blas")


def lean() -> None:
    """BLAS is loaded later with one thread, where it is not loaded yet: a process without threads can be forked.

    For verbs that only run scenarios; what is fitted to recordings is sooner done on several threads.
    """
    for library in ("OPENBLAS", "MKL", "OMP"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
