"""What a replication leaves in memory, and what many of them leave together: not much more, however many they are.

Replications of a Plan, here or on several processes: the same rows either way.

One replication by one engine, with the time it takes and however it ends.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from opsim.engine.choice import REFERENCE, Choice, Run, runner_of
from opsim.kpi import figures, samples
from opsim.kpi.catalogue import Figure
from opsim.kpi.deadlock import Locked, locked
from opsim.log import EventLog, names_of
from opsim.log_parquet import one_database
from opsim.plan import Plan
from opsim.pool import cores, pays, pooled
from opsim.results import Key, events_name
from opsim.streams import stream

MOST_SAMPLES = 20_000
"""Values kept of each sample of a replication for histograms; more are thinned evenly."""
MOST_TOGETHER = 100_000
"""Values kept of each sample in all replications together."""

Sample = tuple[str, str]
"""(kpi, subject)"""
_known: dict[tuple[Key, ...], tuple[Key, ...]] = {}


@dataclass(frozen=True, slots=True)
class Replicated:
    """What one replication leaves in memory; its rows are in its events file."""

    replication: int
    figures: Sequence[Figure]
    samples: dict[Sample, np.ndarray]
    locked: Locked | None = None


class Figures(Sequence[Figure]):
    """Figures of one replication: 8 bytes each, as the names are there once for all replications that have the same."""

    __slots__ = ("_keys", "_values")

    def __init__(self, keys: Iterable[Key], values: Iterable[float]) -> None:
        named = tuple(keys)
        self._keys = _known.setdefault(named, named)
        self._values = np.array(tuple(values), dtype=float)

    @classmethod
    def of(cls, figures: Iterable[Figure]) -> Figures:
        """The same figures."""
        listed = list(figures)
        return cls((figure[:4] for figure in listed), (figure.value for figure in listed))

    def __len__(self) -> int:
        return len(self._keys)

    def __getitem__(self, at: Any) -> Any:
        if isinstance(at, slice):
            return [Figure(*key, value) for key, value in zip(self._keys[at], self._values[at].tolist())]
        key: Key = self._keys[at]
        return Figure(*key, float(self._values[at]))

    def __iter__(self) -> Iterator[Figure]:
        return iter(self[:])

    def __reduce__(self) -> Any:
        return Figures, (self._keys, self._values)


class Together:
    """Replications as they come, in any order; their samples are thinned so that all together stay within a bound.

    Of each sample all replications keep the same share of their values, drawn by lot: all, half, a quarter, ..., the
    first that keeps to the bound. The lot is that of the replication, so that the order they come in decides nothing.
    """

    def __init__(self, most: int = MOST_TOGETHER) -> None:
        self._most = most
        self._done: list[Replicated] = []
        self._sizes: dict[Sample, int] = {}
        self._halved: dict[Sample, int] = {}

    def __len__(self) -> int:
        return len(self._done)

    def add(self, one: Replicated) -> None:
        """One more; what was kept of the others may become less."""
        self._done.append(one := replace(one, samples=dict(one.samples)))
        for key in one.samples:
            if self._halved.get(key):
                _shuffle(one, key)
                for _ in range(self._halved[key]):
                    _halve(one, key)
            self._sizes[key] = self._sizes.get(key, 0) + one.samples[key].size
            while self._sizes[key] > max(self._most, len(self._done)):
                self._halve_all(key)

    def in_order(self) -> list[Replicated]:
        """All of them, by their number."""
        return sorted(self._done, key=lambda one: one.replication)

    def _halve_all(self, key: Sample) -> None:
        having = [one for one in self._done if key in one.samples]
        for one in having:
            if not self._halved.get(key):
                _shuffle(one, key)
            _halve(one, key)
        self._halved[key] = self._halved.get(key, 0) + 1
        self._sizes[key] = sum(one.samples[key].size for one in having)


def _shuffle(one: Replicated, key: Sample) -> None:
    one.samples[key] = stream(0, one.replication, "kept", *key).permutation(one.samples[key])


def _halve(one: Replicated, key: Sample) -> None:
    """Values that were shuffled become half as many; a single one stays."""
    one.samples[key] = one.samples[key][: (one.samples[key].size + 1) // 2].copy()


def together(done: Iterable[Replicated]) -> list[Replicated]:
    """Replications by their number, their samples within the bound for all."""
    kept = Together()
    for one in done:
        kept.add(one)
    return kept.in_order()


def thinned(values: np.ndarray, most: int) -> np.ndarray:
    """At most so many of the values, evenly among them by size; as they are, where they are not more."""
    if values.size <= most:
        return values
    middle = (np.arange(most) + 0.5) * values.size / most - 0.5  # of as many equal parts
    down = np.arange(most) % 2 == 0  # by turns, as parts of two values have no middle one
    return np.sort(values)[np.where(down, np.floor(middle), np.ceil(middle)).astype(int)]


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
    from opsim.laws.audit import audit
    from opsim.log_parquet import write_events

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
    from opsim.log_parquet import read_events

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

    def __reduce__(self) -> tuple[type[Once], tuple[Callable[[], Any]]]:
        return Once, (self._make,)


def _runner(
    make_plan: MakePlan, folder: Path, made_from: str, outputs: tuple[str, ...], engine: Choice = REFERENCE
) -> Callable[[int], Replicated]:
    from opsim import laws  # noqa: F401

    plan = make_plan()
    runner_of(engine)  # imported now: what a process has before it forks, its copies have
    return lambda replication: run_one(plan, replication, folder, made_from, outputs, engine)


QUICK_S = 2.0


@dataclass(frozen=True)
class Timed:
    """logs : of one replication, once or twice; seconds : of the last time; error : what was raised instead"""

    logs: tuple[EventLog, ...] = ()
    seconds: float = 0.0
    error: Exception | None = None

    @property
    def rows(self) -> int:
        """Of the log."""
        return len(self.logs[0]) if self.logs else 0

    @property
    def said(self) -> str:
        """The error in words; nothing where there is none."""
        return "" if self.error is None else f"{type(self.error).__name__}: {self.error}"

    @property
    def words(self) -> str:
        """What came of it."""
        return f"ended with {self.said}" if self.said else f"wrote {self.rows:,} rows"


def timed(choice: Choice, plan: Plan, replication: int) -> Timed:
    """A quick first run is done twice: the first one also loads what it needs, and is on a floor that nobody used."""
    run = runner_of(choice)
    try:
        first = _once(run, plan, replication)
        if replication or first.seconds >= QUICK_S:
            return first
        again = _once(run, plan, replication)
    except Exception as error:  # whatever it is: the other engine may not end so
        return Timed(error=error)
    return Timed((*first.logs, *again.logs), again.seconds)


def _once(run: Run, plan: Plan, replication: int) -> Timed:
    started = time.perf_counter()
    log = run(plan, replication)
    return Timed((log,), time.perf_counter() - started)
