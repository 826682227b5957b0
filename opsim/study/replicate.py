"""Replications of a Plan, here or on several processes: the same rows either way."""

import time
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

from opsim.engine.choice import REFERENCE, Choice, runner_of
from opsim.kpi import figures, samples
from opsim.kpi.locked import locked
from opsim.log import EventLog, names_of
from opsim.log_store import one_database
from opsim.plan import Plan
from opsim.results import events_name
from opsim.study.pool import cores, pays, pooled
from opsim.study.replicated import MOST_SAMPLES, Figures, Replicated, Together, thinned

Progress = Callable[[int, int], None]

LOADING_S = 3.0
"""The first replication may also load compiled code for so long: if it took less, a second one is timed too."""


def events_file(folder: Path, replication: int) -> Path:
    """Where the rows of a replication are."""
    return folder / "events" / events_name(replication)


def missing(folder: Path, replications: int) -> int:
    """How many of so many replications have no rows yet."""
    return sum(not events_file(folder, number).exists() for number in range(replications))


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
    meanwhile: Callable[[], None] | None = None,
    engine: Choice = REFERENCE,
) -> list[Replicated]:
    """Run replications first .. n-1; each one's events file is whole as soon as it is there, and is not run again.

    made_from : names the run; an events file of another one, or one that cannot be read, is made anew
    processes : None takes one, and all cores where the work left is worth it
    outputs   : figures that are asked for, since some are made only then
    meanwhile : what is best done once while other processes compute
    engine    : what runs them; it has been made ready (``make_ready``), so that no process compiles
    Raises BrokenLog where a log contradicts itself, ProcessLost where a process is killed, OSError where a file cannot
    be written. Whatever stops it, Ctrl-C too, what is finished is kept.
    """
    done = Together()
    runner = Once(partial(_runner, make_plan, folder, made_from, tuple(outputs), engine))
    with closing(_results(runner, range(first, replications), processes, meanwhile)) as results:
        for result in results:
            done.add(result)
            if progress is not None:
                progress(first + len(done), replications)
    return done.in_order()


def run_one(
    plan: Plan,
    replication: int,
    folder: Path,
    made_from: str = "",
    outputs: Sequence[str] = (),
    engine: Choice = REFERENCE,
) -> Replicated:
    """One replication: run, audited, written; or read, where its file is there already and is the one asked for."""
    from opsim.laws import audit
    from opsim.log_store import write_events

    path = events_file(folder, replication)
    log = _finished(path, plan, replication, made_from)
    if log is None:
        log = runner_of(engine)(plan, replication)
        audit(log, plan)
        write_events(log, path, made_from)
    kept = {key: thinned(values, MOST_SAMPLES) for key, values in samples(log, plan).items()}
    return Replicated(replication, Figures.of(figures(log, plan, outputs)), kept, locked(log, plan))


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
    runner: Callable[[], Callable[[int], Replicated]],
    replications: Sequence[int],
    processes: int | None,
    meanwhile: Callable[[], None] | None = None,
) -> Generator[Replicated, None, None]:
    left = list(replications)
    if processes is None:
        run, took_s = runner(), []
        while left and processes is None:
            started = time.perf_counter()
            yield run(left.pop(0))
            took_s.append(time.perf_counter() - started)
            processes = _that_pay(took_s, len(left))
    processes = min(processes or 1, len(left))
    if processes > 1:
        yield from pooled(runner, left, processes, meanwhile)
    elif left:
        with one_database():
            yield from map(runner(), left)


def _that_pay(took_s: Sequence[float], left: int) -> int | None:
    """How many processes pay for so many replications left, by what the first ones took; None: not known yet."""
    if not pays(min(took_s) * left):
        return 1
    return cores() if len(took_s) == 2 or took_s[0] > LOADING_S else None


class Once:
    """Makes something when it is first wanted: a forked process has it then, a spawned one makes it anew."""

    def __init__(self, make: Callable[[], Any]) -> None:
        self._make, self._made = make, None

    def __call__(self) -> Any:
        if self._made is None:
            self._made = self._make()
        return self._made

    def __reduce__(self) -> tuple[type["Once"], tuple[Callable[[], Any]]]:
        return Once, (self._make,)


def _runner(
    make_plan: MakePlan, folder: Path, made_from: str, outputs: tuple[str, ...], engine: Choice = REFERENCE
) -> Callable[[int], Replicated]:
    from opsim import laws, log_store  # noqa: F401

    plan = make_plan()
    runner_of(engine)  # imported now: what a process has before it forks, its copies have
    return lambda replication: run_one(plan, replication, folder, made_from, outputs, engine)
