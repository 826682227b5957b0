"""Executors by a name that stands on a command line.

Jobs by any executor of ``concurrent.futures``, a few at a time in its hands.

Jobs on this machine: here, or on several processes where that pays.

A cluster of ``dask.distributed`` as an executor.
"""

from __future__ import annotations

import logging
import re
import socket
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

from opsim.engine import SIMPY
from opsim.pool import Pool, ProcessLost, cores, pays
from opsim.study.jobs.evaluate import NotThere, OtherProcess, answer, answer_far_away, made_from
from opsim.study.jobs.header import made_differ
from opsim.study.jobs.job import Answer, Job, Source
from opsim.study.replication import LOADING_S


@contextmanager
def executor_of(text: str | None) -> Iterator[Executor | None]:
    """``dask:tcp://host:8786`` -> an executor on that cluster; None: this machine. Raises ValueError, OSError."""
    if text is None:
        yield None
        return
    kind, _, address = text.partition(":")
    if kind != "dask" or not address:
        raise ValueError(f"--executor: expected dask:ADDRESS, such as dask:tcp://host:8786, found {text[:60]!r}")

    with cluster(address) as executor:
        yield executor


AT_A_TIME = 64
"""Jobs in an executor's hands where it does not say how many it can do at once."""


class Work(NamedTuple):
    """A job, what decides its answer, and the engine that is asked for, which does not."""

    job: Job
    decided: str
    engine: str = SIMPY


class OtherWorker(ValueError):
    """A worker that would answer otherwise than this process: other versions, or other files."""


def by_executor(executor: Executor, source: Source, work: Iterable[Work]) -> Generator[tuple[Work, Answer], None, None]:
    """Answers as they come. Raises ProcessLost, OtherWorker, and what the work itself raises."""
    source = _anywhere(source)
    at_a_time = max(AT_A_TIME, 4 * (getattr(executor, "_max_workers", None) or 0))
    left, waiting = iter(work), dict[Future[Answer], Work]()
    try:
        while True:
            for one in islice(left, at_a_time - len(waiting)):
                waiting[executor.submit(answer_far_away, source, *one)] = one
            if not waiting:
                return
            for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                yield waiting[future], _result(future, source, waiting[future])
                del waiting[future]
    except BrokenExecutor:
        raise ProcessLost("a process was killed (out of memory?)") from None
    finally:
        for future in waiting:
            future.cancel()


def _result(future: Future[Answer], source: Source, work: Work) -> Answer:
    try:
        return future.result()
    except OtherProcess as other:
        differ = made_differ(other.made, made_from(source, work.job.point.variant))
        raise OtherWorker(f"a worker would not give the same answers; it has: {'; '.join(differ)}") from None
    except NotThere as error:
        raise OtherWorker(f"a worker cannot read what it needs (every worker must): {error}") from None
    except CancelledError:
        raise ProcessLost("the executor has gone") from None
    except ImportError as error:
        raise OtherWorker(f"a worker lacks something that is here: {error}") from None
    except Exception as error:  # what dask raises cannot be named where dask may not be installed; all else goes on
        if isinstance(error, RuntimeError) and "deserializ" in str(error):
            lacks = "has no opsim, or other versions; they need what is installed here"
            raise OtherWorker(f"the scheduler or a worker {lacks}") from None
        if type(error).__module__.partition(".")[0] == "distributed":
            raise ProcessLost(f"the cluster gave up: {' '.join(str(error).split())[:200]}") from None
        raise


def _anywhere(source: Source) -> Source:
    """The same scenario for a process that works in another folder."""
    path = Path(source.file)
    return replace(source, file=str(path.resolve())) if path.is_file() else source


Done = tuple[Work, Answer]


class OnThisMachine:
    """Processes that stay from one batch of jobs to the next, once there was one that was worth them."""

    def __init__(self, source: Source, processes: int | None):
        """processes : None takes one, and all cores where what is left to do is worth it"""
        self._source, self._processes = source, processes
        self._pool: Pool | None = None

    def results(self, work: Sequence[Work]) -> Generator[Done, None, None]:
        """Answers as they come. Whatever ends it early also ends the processes."""
        left = list(work)
        if self._pool is None:
            left = yield from self._until_known(left)
        if not left:
            return
        if self._pool is None:
            self._pool = Pool(partial(_prepared, self._source), self._processes or cores())
        pool, self._pool = self._pool, None
        yield from pool.results(left)
        self._pool = pool

    def close(self) -> None:
        """End the processes, where there are any."""
        if self._pool is not None:
            self._pool.close()
            self._pool = None

    def _until_known(self, left: list[Work]) -> Generator[Done, None, list[Work]]:
        """Do jobs here until it is known whether several processes pay; returned is what is left for them."""
        if self._processes is not None and min(self._processes, len(left)) > 1:
            return left
        one = self._processes is not None or cores() == 1
        took_s: list[float] = []
        while left:
            started = time.perf_counter()
            yield _do(self._source, left.pop(0))
            took_s.append(time.perf_counter() - started)
            known = len(took_s) > 1 or took_s[0] > LOADING_S
            if not one and known and pays(min(took_s) * len(left)):
                break
        return left


def _prepared(source: Source) -> Callable[[Work], Done]:
    return partial(_do, source)


def _do(source: Source, one: Work) -> Done:
    return one, answer(source, one.job, one.engine)


CONNECT_S = 10.0
RETRIES = 3
PORT = 8786


class NoCluster(OSError):
    """Nobody answers at the address of a scheduler."""


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """An executor on the workers of a scheduler, at ``tcp://host:port``.

    Raises ValueError where dask is not installed or the address is none, NoCluster.
    """
    host, port = _read(address)
    if find_spec("distributed") is None:
        raise ValueError("--executor dask: dask is not installed; 'pip install opsim[cluster]' brings it")
    _answers(address, host, port)
    from distributed import Client

    _quiet()
    client: Any = None
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
        executor: Any = client.get_executor(pure=False, retries=RETRIES)
        executor._max_workers = sum(client.nthreads().values())
    except (OSError, ValueError, TypeError) as error:
        raise NoCluster(f"--executor dask:{address}: what answers there is no scheduler ({_words(error)})") from None
    try:
        yield executor
    finally:
        client.close(timeout=5)


def _quiet() -> None:
    """What fails is said once, by us: a worker that was lost is no news where another one takes its work.

    dask gives some of its loggers levels of their own, which that of ``distributed`` does not reach.
    """
    for name in ("distributed", *logging.root.manager.loggerDict):
        if name.partition(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL)


def _read(address: str) -> tuple[str, int]:
    """``tcp://host:port`` or ``host:port`` -> host, port. Raises ValueError."""
    found = re.fullmatch(r"(?:(?:tcp|tls|ucx)://)?(\[[0-9a-fA-F:]+\]|[^\s:/\[\]]+):(\d{1,5})", address)
    if not found or not 0 < int(found[2]) < 65_536:
        raise ValueError(
            f"--executor dask:{address[:60]}: expected dask:tcp://HOST:PORT, such as dask:tcp://node1:{PORT}"
        )
    return found[1].strip("[]"), int(found[2])


def _answers(address: str, host: str, port: int) -> None:
    """Raises NoCluster where nobody listens, or somebody else: dask itself would try for long or for ever.

    A scheduler speaks first, unless the connection is encrypted.
    """
    try:
        with socket.create_connection((host, port), CONNECT_S) as connection:
            if not address.startswith("tls:") and not connection.recv(1):
                raise ConnectionError("it hangs up")
    except OSError as error:
        raise NoCluster(f"--executor dask:{address}: no scheduler answers there ({_words(error)})") from None


def _words(error: Exception) -> str:
    said = (error.strerror if isinstance(error, OSError) else None) or str(error)
    return " ".join(said.split())[:160] or type(error).__name__
