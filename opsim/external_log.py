"""WorkerLog: what the workers of somebody's own model did, row by row, as an EventLog."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from opsim.external_draws import OwnLuck
from opsim.log import CAUSES, IDLE, KINDS, NAMED, ORDER, WAIT, WORK, EventLog, LogWriter, event_log, row
from opsim.performance import Performance
from opsim.problems import natural_key

if TYPE_CHECKING:
    import simpy

CHECKS = (
    "a worker is in exactly one state from joining to closing",
    "the pieces of a performance follow one another, from nothing to at most the whole",
)


class WorkerLog:
    """Rows of one or more workers of one environment and replication: ``work``, and ``wait`` between.

    ``close()`` gives the EventLog so far; it may be asked again when the simulation has gone on.
    """

    def __init__(self) -> None:
        self._writer = LogWriter()
        self._workers: dict[str, int] = {}
        self._tasks: dict[str, int] = {}
        self._doing: dict[str, Performance] = {}
        self._idle_since_s: dict[str, float] = {}
        self._lucks: dict[str, OwnLuck] = {}
        self._env: simpy.Environment | None = None
        self._replication = 0
        self._n_begun = 0

    @property
    def lucks(self) -> dict[str, OwnLuck]:
        """What decides the draws of each worker in it."""
        return dict(self._lucks)

    def join(self, name: str, env: simpy.Environment, replication: int, luck: OwnLuck | None = None) -> None:
        """A worker's rows begin now. Raises ValueError for a name taken, another environment or replication."""
        if name in self._workers:
            raise ValueError(f"log: there is a worker {name!r} in it already")
        if self._workers and env is not self._env:
            raise ValueError(f"log: {name!r} lives in another environment than the workers in it")
        if self._workers and replication != self._replication:
            raise ValueError(f"log: {name!r} is of replication {replication}, the log of {self._replication}")
        self._env, self._replication = env, replication
        self._workers[name] = len(self._workers)
        self._idle_since_s[name] = env.now
        if luck is not None:
            self._lucks[name] = luck

    def next_number(self) -> int:
        """The number of the performance that begins now."""
        self._n_begun += 1
        return self._n_begun - 1

    def begin(self, performance: Performance) -> None:
        """A performance, or a piece of one, begins: the worker waits no longer."""
        self._tasks.setdefault(performance.task, len(self._tasks))
        for waited in self._wait(performance.worker, performance.start_s):
            self._writer.append(waited)
        self._doing[performance.worker] = performance

    def end(self, performance: Performance) -> None:
        """A piece is over."""
        for worked in self._work(performance):
            self._writer.append(worked)
        del self._doing[performance.worker]
        self._idle_since_s[performance.worker] = performance.end_s

    def close(self) -> EventLog:
        """All rows until now, those that are open closed with their progress; audited. Names are in natural order."""
        now_s = 0.0 if self._env is None else self._env.now
        written = self._writer.close(self._replication, now_s, {})
        still_open = event_log(self._open_rows(now_s), now_s, {})
        columns = {name: np.concatenate([written[name], still_open[name]]) for name in written.columns}
        names: dict[str, tuple[str, ...]] = dict.fromkeys(NAMED, ()) | {"kind": KINDS, "cause": CAUSES}
        for column, numbers in (("worker", self._workers), ("task", self._tasks)):
            names[column] = tuple(sorted(numbers, key=natural_key))
            columns[column] = _renumbered(columns[column], [names[column].index(name) for name in numbers])
        order = np.lexsort([columns[name] for name in reversed(ORDER)])
        log = EventLog(self._replication, now_s, {name: column[order] for name, column in columns.items()}, names)
        audit_work(log)
        return log

    def to_frame(self) -> Any:
        """The rows so far as a pandas DataFrame. Raises ImportError where pandas is absent."""
        return self.close().to_frame()

    def _repr_html_(self) -> str:
        return self.close()._repr_html_()

    def _open_rows(self, now_s: float) -> Iterator[tuple]:
        for name in self._workers:
            if name in self._doing:
                yield from self._work(self._doing[name].until(now_s))
            else:
                yield from self._wait(name, now_s)

    def _wait(self, name: str, now_s: float) -> Iterator[tuple]:
        if now_s > self._idle_since_s[name]:
            yield row(WAIT, self._idle_since_s[name], now_s, self._workers[name], cause=IDLE)

    def _work(self, piece: Performance) -> Iterator[tuple]:
        if piece.end_s > piece.start_s:
            yield row(
                *(WORK, piece.start_s, piece.end_s, self._workers[piece.worker]),
                task=self._tasks[piece.task],
                performance_id=piece.number,
                k=piece.k,
                progress_from=piece.progress_from,
                progress_to=piece.progress_to,
                pace_shift=piece.pace_shift,
            )


def audit_work(log: EventLog) -> tuple[str, ...]:
    """Check a worker log against ``CHECKS``; returns them. Raises BrokenLog, naming what is wrong."""
    from opsim.laws.audit import BrokenLog

    for law in (_one_state, _pieces):
        for complaint in law(log):
            raise BrokenLog(f"replication {log.replication}: {complaint}")
    return CHECKS


def _one_state(log: EventLog) -> Iterator[str]:
    for worker in np.unique(log["worker"]):
        rows = log.where(log["worker"] == worker)
        rows = rows.where(np.argsort(rows["start_s"], kind="stable"))
        ends_s = np.r_[rows["start_s"][1:], log.horizon_s]
        for at in np.flatnonzero(rows["end_s"] != ends_s):
            found = "overlap" if rows["end_s"][at] > ends_s[at] else "gap"
            name = log.names["worker"][worker]
            yield f"worker {name}: {found} between {rows['end_s'][at]:g} s and {ends_s[at]:g} s"


def _pieces(log: EventLog) -> Iterator[str]:
    work = log.of(WORK)
    work = work.where(np.lexsort([work["start_s"], work["performance_id"]]))
    first = np.diff(work["performance_id"], prepend=-1) != 0
    expected = np.where(first, 0.0, np.roll(work["progress_to"], 1))
    wrong = (work["progress_from"] != expected) | (work["progress_to"] > 1)
    for at in np.flatnonzero(wrong | (work["progress_to"] < work["progress_from"])):
        yield (
            f"performance {work['performance_id'][at]}: a piece goes from {work['progress_from'][at]:.0%} "
            f"to {work['progress_to'][at]:.0%} where {expected[at]:.0%} was done"
        )


def _renumbered(numbers: np.ndarray, ranks: list[int]) -> np.ndarray:
    """Numbers in order of appearance -> natural ranks; -1 stays."""
    return np.array([*ranks, -1], dtype=numbers.dtype)[numbers]
