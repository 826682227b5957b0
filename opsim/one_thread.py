"""BLAS on one thread, so that results do not depend on how many cores a machine has."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_held: ContextVar[bool] = ContextVar("one BLAS thread is held", default=False)


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Whatever multiplies matrices inside does so on one thread.

    NOTE: finding the libraries takes 0.5 to 5 ms, so that inside such a block another one does nothing.
    """
    if _held.get():
        yield
        return
    from threadpoolctl import threadpool_limits

    token = _held.set(True)
    try:
        with threadpool_limits(limits=1, user_api="blas"):
            yield
    finally:
        _held.reset(token)


def lean() -> None:
    """BLAS is loaded later with one thread, where it is not loaded yet: a process without threads can be forked.

    For verbs that only run scenarios; what is fitted to recordings is sooner done on several threads.
    """
    for library in ("OPENBLAS", "MKL", "OMP"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
