"""Work on several threads of this process: for engines that leave Python to others while they run."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextvars import copy_context
from itertools import islice
from typing import Any

from opsim.log_store import one_database
from opsim.one_thread import one_blas_thread
from opsim.study.pool import WAITING, Prepare


def threaded(
    prepare: Prepare, items: Iterable[Any], threads: int, meanwhile: Callable[[], None] | None = None
) -> Generator[Any, None, None]:
    """Results as they come, in any order, as ``pooled`` gives them from processes; raises what the work itself raises.

    What is prepared is shared by all threads. Whatever ends this early waits for the items in hand, and for no more.
    NOTE: no process is to be forked while this goes on (opsim/forking.py).
    """
    work, left = prepare(), iter(items)
    with one_blas_thread(), one_database():
        pool = ThreadPoolExecutor(threads)

        def submitted(n: int) -> set[Future[Any]]:
            return {pool.submit(copy_context().run, work, item) for item in islice(left, n)}

        try:
            running = submitted(WAITING * threads)
            if meanwhile is not None:
                meanwhile()
            while running:
                done, running = wait(running, return_when=FIRST_COMPLETED)
                running |= submitted(len(done))
                for future in done:
                    yield future.result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
