"""What bodies went through in somebody's own SimPy model: scores of what ``opsim.Worker`` s did there.

>>> import simpy
>>> from opsim import Worker, exposure_of
>>> env = simpy.Environment()
>>> ana = Worker(env, "ana", {"lift": "public_movements/deep_squat"}, seed=7)
>>> _ = env.run(ana.perform("lift"))
>>> seen = exposure_of(ana.log, handling={"lift": {"load_kg": 8, "grip": "fair"}})
>>> seen.minutes("rula_from_5") <= seen.minutes("rula_from_5", at_most=True)
True
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.options import USUAL, Options, checked
from opsim.ergonomics.shift.booking import Booking
from opsim.ergonomics.shift.fold import fold
from opsim.ergonomics.shift.ledger import AT_MOST, KEY, Ledger
from opsim.ergonomics.shift.said import handlings
from opsim.ergonomics.shift.worker_plans import OwnPlan, groups, models_of, plan_of
from opsim.ergonomics.shift.worker_rows import only, whole_days
from opsim.ergonomics.shift.worst import Worst, WorstSeen
from opsim.kpi.exposure import ASKING
from opsim.kpi.exposure_levels import exposure_levels, measured_share
from opsim.kpi.figure import Figure
from opsim.kpi.levels import LEVELS, bounds_of_level, minutes
from opsim.kpi.names import EXPOSURE, SCORED
from opsim.kpi.work_done import work_done
from opsim.log import EventLog
from opsim.problems import did_you_mean, shown


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

        level   : only those at one of ``opsim.kpi.levels.LEVELS``, such as ``rula_from_5``; nan where nothing is known
        at_most : as many as there may be, where scores are intervals; else the least
        Raises ValueError for a name that is not there.
        """
        cells = self._cells(worker, task).together()
        if level is None:
            return float(cells.seconds[0] / 60.0)
        if level not in LEVELS:
            raise ValueError(f"no level {shown(level)}; {did_you_mean(level, LEVELS)}")
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
        from opsim.frames import frame_of_rows

        return frame_of_rows(Figure._fields, self.figures)

    def __str__(self) -> str:
        from opsim.kpi.exposure_table import as_text

        return as_text(self)

    def _repr_html_(self) -> str:
        from opsim.kpi.exposure_table import as_html

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
    figures  : which, by their names in a scenario's outputs; any of ``opsim.kpi.names.EXPOSURE``
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
