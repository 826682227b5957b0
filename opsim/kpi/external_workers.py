"""What a modeller has of his workers' work, whatever it is, as rows and as who did it.

What bodies went through in somebody's own SimPy model: scores of what ``opsim.Worker`` s did there.

>>> import simpy
>>> from opsim import Worker, exposure_of
>>> env = simpy.Environment()
>>> ana = Worker(env, "ana", {"lift": "public_movements/deep_squat"}, seed=7)
>>> _ = env.run(ana.perform("lift"))
>>> seen = exposure_of(ana.log, handling={"lift": {"load_kg": 8, "grip": "fair"}})
>>> seen.minutes("rula_from_5") <= seen.minutes("rula_from_5", at_most=True)
True

What bodies went through as a small table, for a terminal and for a notebook: minutes, by worker and task.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from math import isnan
from typing import Any

import numpy as np

from opsim.ergonomics.options import USUAL, Options, checked
from opsim.ergonomics.shift.day import fold
from opsim.ergonomics.shift.external import OwnPlan, groups, models_of, only, plan_of, rows_of, whole_days
from opsim.ergonomics.shift.frames import WAITING, handlings
from opsim.ergonomics.shift.ledger import AT_MOST, KEY, Booking, Ledger
from opsim.ergonomics.shift.worst import Worst, WorstSeen
from opsim.external_draws import OwnLuck
from opsim.external_log import WorkerLog
from opsim.external_worker import Worker
from opsim.kpi.catalogue import EXPOSURE, SCORED, Figure
from opsim.log import EventLog
from opsim.performance import Performance
from opsim.problems import did_you_mean, shown
from opsim.subjects.exposure.figures import (
    ASKING,
    LEVEL_KPIS,
    bounds_of_level,
    exposure_levels,
    mean_score,
    measured_share,
    minutes,
)

Lucks = dict[str, OwnLuck]
EXPECTED = "a WorkerLog, a list of Performance, or an EventLog with workers=[...]"


def work_done(did: Any, workers: Iterable[Any] | None) -> tuple[EventLog, Lucks]:
    """Rows of work, and by name what decides each worker's draws.

    Raises TypeError for something else, ValueError where it is not known who did it, or where it is of several runs.
    """
    if isinstance(did, WorkerLog):
        found = did.close(), did.lucks
    elif isinstance(did, EventLog):
        found = did, _lucks(workers, did)
    elif isinstance(did, Worker):
        raise TypeError(f"expected {EXPECTED}, found a Worker; give its worker.log")
    else:
        found = _of_pieces(did)
    _must_know_all(*found)
    return found


def _lucks(workers: Iterable[Any] | None, log: EventLog) -> Lucks:
    if workers is None:
        raise ValueError("an EventLog does not say how its workers' work is drawn: give workers=[...] as well")
    named = list(workers)
    for one in named:
        if not isinstance(one, Worker):
            raise TypeError(f"workers: expected Workers, found {shown(one)}")
        if one.luck.replication != log.replication:
            of = f"{one.luck.replication}, the log of {log.replication}"
            raise ValueError(f"workers: {one.name} is of replication {of}")
    return {one.name: one.luck for one in named}


def _of_pieces(did: Any) -> tuple[EventLog, Lucks]:
    pieces: Sequence[Any] = [did] if isinstance(did, Performance) else list(did) if isinstance(did, Iterable) else [did]
    lucks: Lucks = {}
    for one in pieces:
        if not isinstance(one, Performance):
            raise TypeError(f"expected {EXPECTED}, found {shown(one)}")
        luck = one.drawn.luck
        if luck is None:
            raise ValueError(f"{one.worker}, {one.task}: no Worker performed this, so that it cannot be drawn again")
        if lucks.setdefault(one.worker, luck) is not luck and not _same(lucks[one.worker], luck):
            raise ValueError(
                f"worker {one.worker}: these are of two workers, or runs, of one name; score each by itself"
            )
    replications = sorted({luck.replication for luck in lucks.values()})
    if len(replications) > 1:
        raise ValueError(
            f"these are of several replications: {', '.join(map(str, replications))}; score each by itself"
        )
    return rows_of(pieces, *(replications or [0])), lucks


def _same(one: OwnLuck, other: OwnLuck) -> bool:
    names = ("seed", "replication", "workforce", "across_tasks", "body")
    return (
        all(getattr(one, name) == getattr(other, name) for name in names) and one.models.keys() == other.models.keys()
    )


def _must_know_all(log: EventLog, lucks: Lucks) -> None:
    """Raises ValueError with all workers and tasks of a log that nobody knows."""
    named = {(int(worker), int(task)) for worker, task in zip(log["worker"], log["task"]) if worker >= 0 and task >= 0}
    wrong = [
        f"no worker {shown(name)}; {did_you_mean(name, lucks)}" for name in log.names["worker"] if name not in lucks
    ]
    for worker, task in sorted(named):
        whose, what = log.names["worker"][worker], log.names["task"][task]
        if whose in lucks and what not in lucks[whose].models:
            wrong.append(f"worker {whose}: no task {shown(what)}; {did_you_mean(what, lucks[whose].models)}")
    if wrong:
        raise ValueError("\n".join(wrong))
    if not lucks:
        raise ValueError("there are no workers in it")


@dataclass(frozen=True, eq=False)
class WorkExposure:
    """What was gone through, by worker and task; a score is an interval where not all that it asks for was said.

    figures : as a scenario's, of an hour in which a worker is there: from his joining on where a log was given, for as
              long as the pieces last where they were given
    ledger  : the seconds behind them
    log, plan : the rows, and the plan of these workers, for whatever else looks at rows: ``worst_frames(log, plan, 5)``
    """

    figures: tuple[Figure, ...]
    ledger: Ledger
    log: EventLog
    plan: OwnPlan
    seen: WorstSeen

    def value(self, kpi: str, subject: str = "", part: str = "") -> float:
        """One of the figures: ``value("rula_from_5_min_per_h", "ana", "at_most")``.

        Raises KeyError that says which there are.
        """
        for figure in self.figures:
            if (figure.kpi, figure.subject, figure.part) == (kpi, subject, part):
                return float(figure.value)
        raise KeyError(self._no_figure(kpi, subject, part))

    def _no_figure(self, kpi: str, subject: str, part: str) -> str:
        """What is wrong with three words that name no figure, and the nearest ones that do."""
        own = [one for one in self.figures if one.kpi == kpi]
        if not own and kpi in EXPOSURE:
            return f"no figure {kpi!r} was made: ask for it, exposure_of(..., figures=[{kpi!r}])"
        if not own:
            return f"no figure {kpi!r}; {did_you_mean(kpi, dict.fromkeys(one.kpi for one in self.figures))}"
        parts = dict.fromkeys(one.part for one in own if one.subject == subject)
        if not parts:
            subjects = dict.fromkeys(one.subject or "''" for one in own)
            return f"{kpi}: no subject {subject!r}; {did_you_mean(subject, subjects, otherwise='there are')}"
        there = {word or "''" for word in parts}
        return f"{kpi} of {subject!r}: no part {part!r}; {did_you_mean(part, there, otherwise='there are')}"

    def minutes(
        self, level: str | None = None, worker: str | None = None, task: str | None = None, at_most: bool = False
    ) -> float:
        """Minutes of work (and waiting, where it counts) of all, or of one worker or task.

        level   : only those at one of ``LEVEL_KPIS``, such as ``rula_from_5``; nan where nothing is known
        at_most : as many as there may be, where scores are intervals; else the least
        Raises ValueError for a name that is not there.
        """
        cells = self._cells(worker, task).together()
        if level is None:
            return float(cells.seconds[0] / 60.0)
        if level not in LEVEL_KPIS:
            raise ValueError(f"no level {shown(level)}; {did_you_mean(level, LEVEL_KPIS)}")
        bound = AT_MOST if at_most and AT_MOST in bounds_of_level(level) else ""
        return float(minutes(cells, level, bound)[0])

    def worst(self, n: int = 5) -> list[Worst]:
        """The worst postures, of each worker at each task at most one, with their scores and what drives them."""
        return self.seen.worst(self.log, self.plan, n)

    def _cells(self, worker: str | None, task: str | None) -> Ledger:
        found = np.ones(len(self.ledger.key), bool)
        for column, name, named in (("worker", worker, self.plan.workers), ("task", task, self.plan.tasks)):
            names = [one.name for one in named]
            if name is not None and name not in names:
                raise ValueError(f"no {column} {shown(name)}; {did_you_mean(name, names)}")
            if name is not None:
                found &= self.ledger.key[:, KEY.index(column)] == names.index(name)
        return self.ledger.where(found)

    def to_frame(self) -> Any:
        """Its figures as a pandas DataFrame, a row each. Raises ImportError where pandas is absent."""
        from opsim.results import frame_of_rows

        return frame_of_rows(Figure._fields, self.figures)

    def __str__(self) -> str:

        return as_text(self)

    def _repr_html_(self) -> str:

        return as_html(self)

    def __repr__(self) -> str:
        return f"<WorkExposure: {len(self.plan.workers)} workers, {self.minutes():.1f} min of work; print it>"


def exposure_of(
    did: Any,
    workers: Iterable[Any] | None = None,
    *,
    handling: Mapping[str, Any] | None = None,
    options: Options = USUAL,
    figures: Collection[str] = SCORED,
    from_s: float | None = None,
    start_s: float = 0.0,
) -> WorkExposure:
    """Score what workers did, by the code that scores scenarios; each performance is drawn again and looked at once.

    did      : a WorkerLog; or what ``Worker.perform`` and ``resume`` gave, pieces of interrupted performances too; or
               an EventLog of workers (read back from a file), together with ``workers``, who need the same names,
               tasks and seeds
    handling : by task a ``Handling``, or its words: ``{"lift": {"load_kg": 8, "grip": "fair", "end": "place"}}``
    options  : ``opsim.ergonomics.Options``
    figures  : which, by their names in a scenario's outputs; any of ``opsim.kpi.catalogue.EXPOSURE``
    from_s   : what was before is not counted, such as a warm-up
    start_s  : when on the clock 0 is, in seconds after Monday 00:00
    Repetition and holding are told from all that is given: of a few pieces out of a shift they say little.
    Raises TypeError or ValueError, with all mistakes, for what makes no sense.
    """
    asked = _names(figures)
    log, lucks = work_done(did, workers)
    said = handlings(handling, models_of(lucks.values()))
    window_s = _window_s(log, from_s)
    log = whole_days(log, models_of(lucks.values()), window_s[0])
    parted = [(group, plan_of(lucks, group, said, checked(options), window_s, start_s)) for group in groups(lucks)]
    plan, seen, booking = parted[0][1], WorstSeen(), Booking(start_s)
    wanted = [asking for asking in ASKING if not set(asking.names).isdisjoint(asked)]
    folds = [asking.make(log, plan) for asking in wanted]
    for group, own in parted:
        ranks = [rank for rank, worker in enumerate(own.workers) if worker.name in group]
        fold(log if len(parted) == 1 else only(log, ranks), own, [booking, seen, *folds])
    found = [*exposure_levels(booking, log, plan)] if not set(SCORED).isdisjoint(asked) else []
    for asking, made in zip(wanted, folds):
        found += asking.figures(made, log, plan)
    found += measured_share(booking, plan)
    return WorkExposure(tuple(found), booking.close(), log, plan, seen)


def _names(figures: Collection[str]) -> set[str]:
    names = {figures} if isinstance(figures, str) else set(figures)
    wrong = [f"figures: no {shown(name)}; {did_you_mean(name, EXPOSURE)}" for name in names if name not in EXPOSURE]
    if wrong:
        raise ValueError("\n".join(sorted(wrong)))
    return names


def _window_s(log: EventLog, from_s: float | None) -> tuple[float, float]:
    if from_s is not None:
        number = isinstance(from_s, int | float) and not isinstance(from_s, bool)
        if not number or not from_s < log.horizon_s:
            until = f"{log.horizon_s:g} s, when it ends"
            raise ValueError(f"from_s: found {shown(from_s)}, expected seconds of the log below {until}")
        return float(from_s), log.horizon_s
    return float(log["start_s"].min()) if len(log) else log.horizon_s, log.horizon_s


TITLES = {
    "rula_from_5": "RULA 5+",
    "rula_from_7": "RULA 7",
    "reba_from_8": "REBA 8+",
    "owas_from_3": "OWAS 3+",
    "trunk_beyond_20": "trunk>20",
    "trunk_beyond_60": "trunk>60",
    "arm_beyond_60": "arm>60",
    "arm_beyond_90": "arm>90",
}
HEAD = ("worker", "task", "minutes", "unknown", *TITLES.values(), "RULA mean")
FOOT = "minutes; a-b: at least and at most, as grip, support and the like were not said for all tasks"


def as_text(found: Any) -> str:
    """A line each: every worker at every task, and all of it."""
    rows = [HEAD, *_rows(found)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEAD))]
    lines = ["  ".join(_put(cell, width, at) for at, (cell, width) in enumerate(zip(row, widths))) for row in rows]
    return "\n".join([*(line.rstrip() for line in lines), *_foot(rows)])


def as_html(found: Any) -> str:
    """The same as a table of a notebook."""
    head, *rows = (HEAD, *_rows(found))
    body = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
    foot = "".join(f"<p>{escape(line)}</p>" for line in _foot(rows))
    return f"<table><tr>{''.join(f'<th>{escape(cell)}</th>' for cell in head)}</tr>{body}</table>{foot}"


def _rows(found: Any) -> Iterator[tuple[str, ...]]:
    ledger, tasks = found.ledger, {rank: task.name for rank, task in enumerate(found.plan.tasks)}
    tasks[WAITING] = "waiting"
    for rank, worker in enumerate(found.plan.workers):
        own = ledger.where(ledger.key[:, KEY.index("worker")] == rank)
        for task in np.unique(own.key[:, KEY.index("task")]).tolist():
            yield worker.name, tasks[task], *_cells(own.where(own.key[:, KEY.index("task")] == task))
    yield "all", "", *_cells(ledger)


def _cells(ledger: Ledger) -> Iterator[str]:
    one = ledger.together()
    yield f"{one.seconds[0] / 60:.1f}"
    yield f"{one.unmeasured_s[0] / 60:.1f}"
    for level in TITLES:
        yield _span(*(float(minutes(one, level, bound)[0]) for bound in bounds_of_level(level)))
    yield _span(*(float(mean_score(one, f"rula{bound}")[0]) for bound in ("", AT_MOST)))


def _span(low: float, high: float | None = None) -> str:
    if isnan(low):
        return "?"
    least, most = f"{low:.1f}", f"{low if high is None else high:.1f}"
    return least if least == most else f"{least}-{most}"


def _put(cell: str, width: int, at: int) -> str:
    return cell.ljust(width) if at < 2 else cell.rjust(width)


def _foot(rows: list[tuple[str, ...]]) -> list[str]:
    return [FOOT] if any("-" in cell for row in rows for cell in row[2:]) else []
