"""The worst postures of a replication, one of each worker at each task: who, where, when, how, and why.

How fast a worker gathers posture dose at a task: what a rule that evens out exposure can know before the shift.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.clock import DAY_S, DAYS, on_the_clock
from opsim.ergonomics.angles import AT
from opsim.ergonomics.measures import has_body, measures_of, n_cells
from opsim.ergonomics.redraw import neck_neutrals_rad, performance_again
from opsim.ergonomics.scores.explain import explain
from opsim.ergonomics.scores.scoring import Scores, bounds_of, score
from opsim.ergonomics.shift.day import fold, said_of
from opsim.ergonomics.shift.frames import Frames
from opsim.log import EventLog
from opsim.plan import Plan

BENT = [AT[name] for name in ("trunk_flexion", "left_arm_elevation", "right_arm_elevation")]
Pair = tuple[int, int]


@dataclass(frozen=True, repr=False)
class Worst:
    """A posture that was gone through.

    worker, task, station, product : names, "" where there is none
    at_s, clock : when, in seconds of the run and as "Mon 07:12:05"; row, k, progress : where in the log, which
                  performance, and where in it, 0 to 1
    seconds     : of the window for which this worker, at this task, had at least this score of RULA (the low one)
    rula, reba, owas : low and high; why : sub-scores and what drives them, as ``explained.explain``
    carrying, repeated, static : as ``Frames``; load_kg : what the scenario says of the load, None where it does not
    measures    : (COLUMNS,); joints_m : (J, 3), and the skeleton they are of
    """

    worker: str
    task: str
    station: str
    product: str
    at_s: float
    clock: str
    row: int
    k: int
    progress: float
    seconds: float
    rula: Pair
    reba: Pair
    owas: Pair
    why: dict[str, dict[str, Any]]
    carrying: bool
    repeated: bool
    static: bool
    load_kg: float | None
    measures: np.ndarray
    joints_m: np.ndarray
    skeleton: Any

    def __repr__(self) -> str:
        """Who, at what, when and the scores; arrays are left out."""
        scores = zip(("RULA", "REBA", "OWAS"), (self.rula, self.reba, self.owas))
        said = ", ".join(f"{name} {low}" if low == high else f"{name} {low} to {high}" for name, (low, high) in scores)
        return f"<Worst: {self.worker} at {self.task}, {self.clock}: {said}>"


def worst_frames(log: EventLog, plan: Plan, n: int) -> list[Worst]:
    """At most n postures, the worst first; none of walking and waiting. Raises what ``days`` raises."""
    seen = WorstSeen()
    fold(log, plan, [seen])
    return seen.worst(log, plan, n)


class WorstSeen:
    """A fold that keeps the worst frame of each worker at each task: the highest RULA, then REBA, then OWAS.

    Low scores come before high ones; of equal scores the one more bent (trunk and arms), then the first.
    """

    def __init__(self) -> None:
        self._kept: dict[tuple[int, int], tuple[tuple[float, ...], Frames, Scores]] = {}
        self._seconds: dict[tuple[int, int], np.ndarray] = {}

    def add(self, frames: Frames, scores: Scores) -> None:
        """The next stretch."""
        worth, bent = _worth(scores), np.nan_to_num(np.abs(frames.measures[:, BENT])).sum(axis=1)
        for task in np.unique(frames.task[(frames.task >= 0) & (worth > 0)]).tolist():
            own, at = np.flatnonzero(frames.task == task), (frames.worker, task)
            top = own[np.lexsort([-own, bent[own], worth[own]])[-1]]
            key = float(worth[top]), float(bent[top])
            if at not in self._kept or key > self._kept[at][0]:
                one = np.array([top])
                self._kept[at] = key, frames.some(one), scores.some(one)
            by_score = np.bincount(scores.rula[own, 0], frames.seconds[own], 8)
            self._seconds[at] = self._seconds.get(at, 0.0) + by_score

    def worst(self, log: EventLog, plan: Plan, n: int, *, one_a_task: bool = False) -> list[Worst]:
        """The n worst of all that were kept, each drawn again; one_a_task : of each task only the worst."""
        ordered = sorted(self._kept.items(), key=lambda item: (*(-value for value in item[1][0]), item[0]))
        if one_a_task:
            first = {task: place for place, ((_, task), _) in reversed(list(enumerate(ordered)))}
            ordered = [ordered[place] for place in sorted(first.values())]
        return [_worst(log, plan, frames, scores, self._seconds[at]) for at, (_, frames, scores) in ordered[:n]]


def _worth(scores: Scores) -> np.ndarray:
    """(N,) a number that orders scores: RULA, REBA and OWAS at least, then at most; 0 where nothing is known."""
    found = np.zeros(len(scores.rula), np.int64)
    for bound in (0, 1):
        for name in ("rula", "reba", "owas"):
            found = 16 * found + getattr(scores, name)[:, bound]
    return found


def _worst(log: EventLog, plan: Plan, frames: Frames, scores: Scores, seconds: np.ndarray) -> Worst:
    row, task = int(frames.row[0]), plan.tasks[int(frames.task[0])]
    rula, reba, owas = (tuple(getattr(scores, name)[0].tolist()) for name in ("rula", "reba", "owas"))
    flags = {name: bool(getattr(frames, name)[0]) for name in ("carrying", "repeated", "static")}
    measures, at_s = frames.measures[0], float(frames.start_s[0])
    joints_m, skeleton = _joints_m(log, plan, row, float(frames.progress[0]))
    return Worst(
        worker=plan.workers[frames.worker].name,
        task=task.name,
        station=_named(log, "station", row),
        product=_named(log, "product", row),
        at_s=at_s,
        clock=clock_of(plan, at_s),
        row=row,
        k=int(frames.k[0]),
        progress=float(frames.progress[0]),
        seconds=float(seconds[rula[0] :].sum()),
        rula=rula,
        reba=reba,
        owas=owas,
        why=explain(measures, said_of(int(frames.task[0]), plan), plan.ergonomics, **flags),
        **flags,
        load_kg=task.handling.load_kg,
        measures=measures,
        joints_m=joints_m,
        skeleton=skeleton,
    )


def clock_of(plan: Plan, at_s: float) -> str:
    """An instant of a run as "Mon 07:12:05"."""
    on_s = plan.start_s + at_s
    return f"{DAYS[int(on_s // DAY_S) % len(DAYS)]} {on_the_clock(on_s)}"


def _named(log: EventLog, column: str, row: int) -> str:
    number = int(log[column][row])
    return log.names[column][number] if number >= 0 else ""


def _joints_m(log: EventLog, plan: Plan, row: int, progress: float) -> tuple[np.ndarray, Any]:
    """The joints of one posture of the performance behind a row, and the skeleton.

    NOTE: as it was looked at; where people tire, the posture at most half a frame beside it.
    """
    drawn = performance_again(log, plan, row).drawn
    cells = n_cells(drawn.block, plan.ergonomics)
    cell = min(int(progress * cells), cells - 1)
    return drawn.decoded("positions_m", n_times=2 * cells + 1)[2 * cell + 1], drawn.block.skeleton


N_DRAWS = 16
"""Performances of the worker that are looked at: their mean RULA stands within 0.1 of the mean of many."""


class DoseRates:
    """Mean RULA, the least that it may be, a second of work; each (worker, task) is looked at when it is asked for.

    Times without a body, and tasks that the station does alone, have 0: what nobody has seen is no dose.
    """

    def __init__(self, plan: Plan, workforce: int):
        self._plan, self._workforce = plan, workforce
        self._found: dict[tuple[int, int], float] = {}
        self._neutral_rad: dict[str, float] | None = None

    def per_s(self, worker: int, task: int) -> float:
        """RULA x seconds of a second of work, by ranks."""
        if (worker, task) not in self._found:
            self._found[worker, task] = self._mean(worker, task)
        return self._found[worker, task]

    def _mean(self, worker: int, task: int) -> float:
        """Over performances of his own: stream ``dose, task, worker`` of the workforce."""
        from opsim.streams import stream
        from opsim.threads import one_blas_thread

        plan, person, named = self._plan, self._plan.workers[worker], self._plan.tasks[task]
        if named.automatic or named.attended:
            return 0.0
        with one_blas_thread():
            effect = plan.worker_effect(worker, named, workforce=self._workforce)
            rng = stream(plan.seed, self._workforce, "dose", named.stream_name, person.name, 0)
            block = named.model.sample(N_DRAWS, rng, worker=effect)
            return self._mean_rula(block, named) if has_body(block) else 0.0

    def _mean_rula(self, block: Any, named: Any) -> float:
        """Weighted by time: each performance has as many parts as every other one, of its own length."""
        options = self._plan.ergonomics
        measures = measures_of(block, np.arange(N_DRAWS), options, self._neutral(named.name))
        n, parts, _ = measures.shape
        known = np.isfinite(measures).any(axis=2)
        rula = score(measures.reshape(n * parts, -1), bounds_of(named.handling), options).rula[:, 0].reshape(n, parts)
        weights = np.asarray(block.duration_s)[:, None] * known
        return float((rula * weights).sum() / weights.sum()) if weights.any() else 0.0

    def _neutral(self, task: str) -> float:
        if self._neutral_rad is None:
            self._neutral_rad = neck_neutrals_rad({one.name: one.model for one in self._plan.tasks})
        return self._neutral_rad[task]


_KEPT: deque[tuple[Plan, int, DoseRates]] = deque(maxlen=4)


def dose_rates_of(plan: Plan, workforce: int) -> DoseRates:
    """The rates of a plan and a workforce; those asked for last are kept, since all replications ask for the same."""
    for other, number, rates in _KEPT:
        if other is plan and number == workforce:
            return rates
    _KEPT.append((plan, workforce, DoseRates(plan, workforce)))
    return _KEPT[-1][2]
