"""The worst postures of a replication, one of each worker at each task: who, where, when, how, and why."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.clock import DAY_S, DAYS, on_the_clock
from opsim.ergonomics.again import performance_again
from opsim.ergonomics.columns import AT
from opsim.ergonomics.measures import n_cells
from opsim.ergonomics.scores.explained import explain
from opsim.ergonomics.scores.scoring import Scores
from opsim.ergonomics.shift.fold import fold
from opsim.ergonomics.shift.scored import said_of
from opsim.ergonomics.shift.stretch import Frames
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
