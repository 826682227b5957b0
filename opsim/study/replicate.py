"""Replications of a Plan, here or on several processes: the same rows either way."""

import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from opsim.kpi import Figure, figures, samples
from opsim.plan import Plan

Progress = Callable[[int, int], None]

WORTH_A_POOL_S = 4.0
"""Processes cost about two seconds to start: below this much work left, one process is sooner done."""
MOST_SAMPLES = 20_000
"""Values kept of each sample for histograms; more are thinned evenly."""


@dataclass(frozen=True, slots=True)
class Replicated:
    """What one replication leaves in memory; its rows are in its events file."""

    replication: int
    figures: list[Figure]
    samples: dict[tuple[str, str], np.ndarray]


def events_file(folder: Path, replication: int) -> Path:
    """Where the rows of a replication are."""
    return folder / "events" / f"replication_{replication:05d}.parquet"


MakePlan = Callable[[], Plan]
"""Makes the Plan anew in each process: what it is made from is small, a Plan with its emulators is not.

NOTE: a process that dies before it has read its arguments blocks its parent for ever where they exceed a pipe's 64 kB.
"""


def replicate(
    make_plan: MakePlan,
    replications: int,
    folder: Path,
    *,
    processes: int | None = None,
    progress: Progress | None = None,
) -> list[Replicated]:
    """Run replications 0 .. n-1; each one's events file is whole as soon as it is there, and is not run again.

    processes : None takes one, and all cores where the work left is worth it
    Raises BrokenLog where a log contradicts itself. Ctrl-C keeps what is finished.
    """
    done: list[Replicated] = []
    for result in _results(make_plan, replications, folder, processes):
        done.append(result)
        if progress is not None:
            progress(len(done), replications)
    return sorted(done, key=lambda result: result.replication)


def run_one(plan: Plan, replication: int, folder: Path) -> Replicated:
    """One replication: run, audited, written; or read, where its file is there already."""
    from opsim.laws import audit
    from opsim.engine.simpy_engine import run_plan
    from opsim.log_store import read_events, write_events

    path = events_file(folder, replication)
    if path.exists():
        log = read_events(path)
    else:
        log = run_plan(plan, replication)
        audit(log, plan)
        write_events(log, path)
    kept = {key: _thinned(values) for key, values in samples(log, plan).items()}
    return Replicated(replication, figures(log, plan), kept)


def _results(make_plan: MakePlan, replications: int, folder: Path, processes: int | None) -> Iterator[Replicated]:
    plan = make_plan()
    left = list(range(replications))
    if processes is None:
        started = time.perf_counter()
        yield run_one(plan, left.pop(0), folder)
        worth = (time.perf_counter() - started) * len(left) > WORTH_A_POOL_S
        processes = (os.cpu_count() or 1) if worth else 1
    if min(processes, len(left)) <= 1:
        for replication in left:
            yield run_one(plan, replication, folder)
        return
    context = get_context("spawn")  # a fork would copy the locks of whatever threads run by then
    with ProcessPoolExecutor(
        min(processes, len(left)), context, initializer=_keep, initargs=(make_plan, folder)
    ) as pool:
        yield from _pooled(pool, left)


def _pooled(pool: Executor, replications: list[int]) -> Iterator[Replicated]:
    futures: list[Future[Replicated]] = [pool.submit(_run_kept, replication) for replication in replications]
    try:
        for future in as_completed(futures):
            yield future.result()
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        raise


_kept: dict[str, tuple[Plan, Path]] = {}


def _keep(make_plan: MakePlan, folder: Path) -> None:
    _kept["task"] = make_plan(), folder


def _run_kept(replication: int) -> Replicated:
    plan, folder = _kept["task"]
    return run_one(plan, replication, folder)


def _thinned(values: np.ndarray) -> np.ndarray:
    if values.size <= MOST_SAMPLES:
        return values
    return np.sort(values)[np.linspace(0, values.size - 1, MOST_SAMPLES).astype(int)]
