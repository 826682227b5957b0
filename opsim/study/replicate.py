"""Replications of a Plan, here or on several processes: the same rows either way."""

import os
import time
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from opsim.kpi import Figure, figures, samples
from opsim.kpi.locked import Locked, locked
from opsim.log import EventLog, names_of
from opsim.plan import Plan
from opsim.study.pool import pooled

Progress = Callable[[int, int], None]

WORTH_A_POOL_S = 4.0
"""Processes cost about two seconds to start: below this much work left, one process is sooner done."""
LOADING_S = 3.0
"""The first replication may also load compiled code for so long: if it took less, a second one is timed too."""
MOST_SAMPLES = 20_000
"""Values kept of each sample for histograms; more are thinned evenly."""


@dataclass(frozen=True, slots=True)
class Replicated:
    """What one replication leaves in memory; its rows are in its events file."""

    replication: int
    figures: list[Figure]
    samples: dict[tuple[str, str], np.ndarray]
    locked: Locked | None = None


def events_file(folder: Path, replication: int) -> Path:
    """Where the rows of a replication are."""
    return folder / "events" / f"replication_{replication:05d}.parquet"


MakePlan = Callable[[], Plan]
"""Makes the Plan anew in each process: what it is made from is small, a Plan with its emulators is not."""


def replicate(
    make_plan: MakePlan,
    replications: int,
    folder: Path,
    *,
    first: int = 0,
    made_from: str = "",
    processes: int | None = None,
    progress: Progress | None = None,
    outputs: Sequence[str] = (),
) -> list[Replicated]:
    """Run replications first .. n-1; each one's events file is whole as soon as it is there, and is not run again.

    made_from : names the run; an events file of another one, or one that cannot be read, is made anew
    processes : None takes one, and all cores where the work left is worth it
    outputs   : figures that are asked for, since some are made only then
    Raises BrokenLog where a log contradicts itself, ProcessLost where a process is killed, OSError where a file cannot
    be written. Whatever stops it, Ctrl-C too, what is finished is kept.
    """
    done: list[Replicated] = []
    runner = partial(_runner, make_plan, folder, made_from, tuple(outputs))
    with closing(_results(runner, range(first, replications), processes)) as results:
        for result in results:
            done.append(result)
            if progress is not None:
                progress(first + len(done), replications)
    return sorted(done, key=lambda result: result.replication)


def run_one(plan: Plan, replication: int, folder: Path, made_from: str = "", outputs: Sequence[str] = ()) -> Replicated:
    """One replication: run, audited, written; or read, where its file is there already and is the one asked for."""
    from opsim.engine.simpy_engine import run_plan
    from opsim.laws import audit
    from opsim.log_store import write_events

    path = events_file(folder, replication)
    log = _finished(path, plan, replication, made_from)
    if log is None:
        log = run_plan(plan, replication)
        audit(log, plan)
        write_events(log, path, made_from)
    kept = {key: _thinned(values) for key, values in samples(log, plan).items()}
    return Replicated(replication, figures(log, plan, outputs), kept, locked(log, plan))


def _finished(path: Path, plan: Plan, replication: int, made_from: str) -> EventLog | None:
    """The rows in the file, or None where it is missing, damaged, or not this replication of this plan."""
    from opsim.log_store import read_events

    try:
        log = read_events(path, made_from) if path.exists() else None
    except OSError:
        return None
    if log is None or (log.replication, log.horizon_s) != (replication, plan.horizon_s) or log.names != names_of(plan):
        return None
    return log


def _results(
    runner: Callable[[], Callable[[int], Replicated]], replications: Sequence[int], processes: int | None
) -> Generator[Replicated, None, None]:
    run = runner()
    left = list(replications)
    took_s: list[float] = []
    while processes is None and left:
        started = time.perf_counter()
        yield run(left.pop(0))
        took_s.append(time.perf_counter() - started)
        if min(took_s) * len(left) <= WORTH_A_POOL_S:
            processes = 1
        elif len(took_s) == 2 or took_s[0] > LOADING_S:
            processes = os.cpu_count() or 1
    processes = min(processes or 1, len(left))
    if processes > 1:
        yield from pooled(runner, left, processes)
    else:
        yield from (run(replication) for replication in left)


def _runner(make_plan: MakePlan, folder: Path, made_from: str, outputs: tuple[str, ...]) -> Callable[[int], Replicated]:
    plan = make_plan()
    return lambda replication: run_one(plan, replication, folder, made_from, outputs)


def _thinned(values: np.ndarray) -> np.ndarray:
    if values.size <= MOST_SAMPLES:
        return values
    return np.sort(values)[np.linspace(0, values.size - 1, MOST_SAMPLES).astype(int)]
