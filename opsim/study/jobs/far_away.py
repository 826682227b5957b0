"""Jobs by any executor of ``concurrent.futures``, a few at a time in its hands."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from opsim.engine.choice import SIMPY
from opsim.study.jobs.answer import Answer
from opsim.study.jobs.decides import made_from
from opsim.study.jobs.evaluate_here import NotThere, OtherProcess, answer_far_away
from opsim.study.jobs.header import made_differ
from opsim.study.jobs.job import Job
from opsim.study.jobs.source import Source
from opsim.study.pool import ProcessLost

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
