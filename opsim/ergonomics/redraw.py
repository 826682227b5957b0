"""Pieces of work in the window of a log, and the draws they come from, block by block.

Any performance of an EventLog again, or the piece of it that a row tells of, with the body behind it.

The neutral of necks: how far forward of the trunk the head of somebody stands who looks ahead.

Heads stand 10 to 25 degrees forward of the trunk, depending on where the markers are. Nobody recorded that posture for
its own sake, so it is taken from how performances begin: the median over those that begin upright. Where somebody
begins with the head turned down to the work, or holds a bar overhead, the median of one task is off by that; so tasks
of the same recordings share the median of theirs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from opsim.clock import on_grid
from opsim.ergonomics.angles import AT
from opsim.ergonomics.measures import first_measures, has_body
from opsim.ergonomics.shift.external import OwnPlan
from opsim.external_draws import OwnLuck
from opsim.log import SETUP, WORK, EventLog
from opsim.performance import Drawn, Performance
from opsim.plan import Plan
from opsim.streams import BLOCK, stream
from opsim.threads import one_blas_thread


class Pieces(NamedTuple):
    """Pieces of performances, each (P,): whose, of which task, the k-th, from and to which progress, for how long.

    pace_shift : by how much the log time of the whole performance was shifted; None: not at all
    """

    worker: np.ndarray
    task: np.ndarray
    k: np.ndarray
    progress_from: np.ndarray
    progress_to: np.ndarray
    seconds: np.ndarray
    pace_shift: np.ndarray | None = None

    def some(self, rows: np.ndarray | slice) -> Pieces:
        """A few of them."""
        shift = None if self.pace_shift is None else self.pace_shift[rows]
        worker, task, k = self.worker[rows], self.task[rows], self.k[rows]
        return Pieces(worker, task, k, self.progress_from[rows], self.progress_to[rows], self.seconds[rows], shift)


def pieces_in_window(log: EventLog, plan: Plan) -> Pieces:
    """All work of workers, set-ups too, as far as it lies in the window, by worker, task, k and time."""
    low, high = plan.window_s
    rows = worked_rows(log, low, high)
    return pieces_of(log, rows[np.lexsort([log[name][rows] for name in ("start_s", "k", "task", "worker")])], low, high)


def worked_rows(log: EventLog, low_s: float, high_s: float) -> np.ndarray:
    """(n,) rows in which a worker performs a task between two times, in the order of the log."""
    inside = np.minimum(log["end_s"], high_s) > np.maximum(log["start_s"], low_s)
    return np.flatnonzero(inside & np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0) & (log["task"] >= 0))


def pieces_of(log: EventLog, rows: np.ndarray, low_s: float | np.ndarray, high_s: float | np.ndarray) -> Pieces:
    """Some rows of work, as far as they lie between two times (each one, or (n,) a time a row)."""
    begun_s, ended_s, done = log["start_s"][rows], log["end_s"][rows], log["progress_from"][rows]
    start_s, end_s = np.maximum(begun_s, low_s), np.minimum(ended_s, high_s)
    a_second = (log["progress_to"][rows] - done) / (ended_s - begun_s)
    first, last = (done + a_second * (edge_s - begun_s) for edge_s in (start_s, end_s))
    shift = log["pace_shift"][rows]
    worker, task, k = (log[name][rows] for name in ("worker", "task", "k"))
    return Pieces(worker, task, k, first, last, end_s - start_s, shift if np.any(shift) else None)


Lucks = dict[int, OwnLuck]
"""By the rank of a worker."""


def drawn_again(
    pieces: Pieces, replication: int, plan: Plan, lucks: Lucks | None = None
) -> Iterator[tuple[Any, Pieces]]:
    """Each block of draws, once and one at a time, with its pieces: they are all of one worker and one task.

    Where pieces were slowed, or quickened, by human effects, the postures are those that go with it, from the same
    noise; times are those of the block, to be stretched to the pieces'. A model that takes no shift (``takes_shift``)
    is stretched alone.

    pieces : by worker, task and k
    lucks  : kept by who asks again and again; what is not in it is added
    Raises ValueError where a task's model draws what is no time.
    """
    lucks = {} if lucks is None else lucks
    for rank in np.unique(pieces.worker).tolist():
        own = pieces.some(pieces.worker == rank)
        if rank not in lucks:
            lucks[rank] = luck_of(plan, rank, replication)
        for rows in alike(own.task, own.k // BLOCK):
            some = own.some(rows)
            yield lucks[rank].slowed(plan.tasks[some.task[0]].name, int(some.k[0]) // BLOCK, _shifts(some)), some


def _shifts(pieces: Pieces) -> np.ndarray:
    """(BLOCK,) by how much each performance of a block is shifted; all pieces of one are alike."""
    found = np.zeros(BLOCK)
    if pieces.pace_shift is not None:
        found[pieces.k % BLOCK] = pieces.pace_shift
    return found


def luck_of(plan: Plan, rank: int, replication: int) -> OwnLuck:
    """What decides the draws of a worker: his own, where the plan is of workers of somebody else's model."""
    if isinstance(plan, OwnPlan):
        return plan.lucks[rank]
    person, models = plan.workers[rank], {task.name: task.model for task in plan.tasks}
    workforce = plan.workforce_of(replication)
    named = {task.name: task.stream_name for task in plan.tasks}
    return OwnLuck(person.name, models, plan.seed, replication, workforce, person.body, plan.across_tasks, named)


def alike(*columns: np.ndarray) -> list[slice]:
    """Rows one after the other that are the same in every one of some sorted columns."""
    changed = np.any([column[1:] != column[:-1] for column in columns], axis=0)
    edges = [0, *(np.flatnonzero(changed) + 1).tolist(), columns[0].size]
    return [slice(start, stop) for start, stop in pairwise(edges)]


def performance_again(log: EventLog, plan: Plan, row: int) -> Performance:
    """The piece of a performance behind a row of work or set-up of a worker.

    Where human effects shifted its time, the postures follow, from the same noise (``pieces.drawn_again``).
    Its postures are those between its own ``progress_from`` and ``progress_to``: pieces of one performance follow each
    other without a jump; who took over goes on, in a performance of his own, from where the other had come to.
    Raises ValueError where the row is no work of a worker, or where a task's model draws what is no time.
    """
    kind, worker, task, k = (int(log[name][row]) for name in ("kind", "worker", "task", "k"))
    if kind not in (WORK, SETUP) or min(worker, task, k) < 0:
        raise ValueError(f"row {row} is no work of a worker: there is no performance behind it")
    person, named = plan.workers[worker], plan.tasks[task]
    drawn = _drawn(luck_of(plan, worker, log.replication), named.name, k, float(log["pace_shift"][row]))
    begun, done = float(log["progress_from"][row]), float(log["progress_to"][row])
    start_s, end_s = float(log["start_s"][row]), float(log["end_s"][row])
    rating = person.rating[int(log["station"][row])]
    by_row = named.automatic or named.attended or rating <= 0 or (plan.human.changes_times and done > begun)
    whole_s = on_grid((end_s - start_s) / (done - begun) if by_row else drawn.duration_s / rating)
    return Performance(
        person.name,
        named.name,
        k,
        start_s,
        end_s,
        whole_s,
        tuple((drawn.mark_s * (whole_s / drawn.duration_s)).tolist()),
        begun,
        done,
        int(log["performance_id"][row]),
        drawn,
    )


def _drawn(luck: OwnLuck, task: str, k: int, shift: float) -> Drawn:
    """The k-th performance of a task, with the postures that go with a shift of its log time."""
    if not shift:
        return luck.performance(task, k)
    shifts = np.zeros(BLOCK)
    shifts[k % BLOCK] = shift
    return Drawn(luck.slowed(task, k // BLOCK, shifts), k % BLOCK)


UPRIGHT_DEG = 15.0
"""A trunk within this of upright, forward and to the side, stands."""
WALKS = 8
"""They are drawn step by step, a hundred times as slowly as other work, and all begin in one posture."""
ENOUGH = 0.5
"""Of the performances this share must begin upright, else they do not tell."""


def neck_neutral_rad(performances: Any) -> float:
    """The neutral of a task model, or of a block of performances, in radians; 0 where it cannot be told.

    Of a model 64 performances of anybody are drawn (8 walks), always the same: stream ``neutral`` of seed 0.
    """
    told = neck_neutral_told_rad(performances)
    return 0.0 if told is None else told


def neck_neutral_told_rad(performances: Any) -> float | None:
    """The same, None where it cannot be told."""
    with one_blas_thread():
        return _told_rad(_drawn_neutral(performances))


def neck_neutrals_rad(models: Mapping[str, Any]) -> dict[str, float]:
    """The neutral of each task by its name, in radians: the median over the tasks of the same recordings and skeleton.

    A task that cannot tell takes that of the others; where none can it is 0. Times without a body have 0.
    """
    with one_blas_thread():
        drawn = {task: _drawn_neutral(model) for task, model in models.items()}
        told = {task: _told_rad(block) for task, block in drawn.items()}
    kin = {task: _kin(model, drawn[task]) for task, model in models.items()}
    return {task: _median([told[other] for other in models if kin[other] == kin[task]]) for task in models}


def _drawn_neutral(performances: Any) -> Any:
    """A block of a model; a block is one already."""
    if not hasattr(performances, "sample"):
        return performances
    n = WALKS if getattr(performances, "walks", False) else BLOCK
    return performances.sample(n, stream(0, 0, "neutral", 0))


def neutral_told_rad(first: np.ndarray) -> float | None:
    """From measures (n, COLUMNS) of postures in which performances begin, necks against the trunk; None: not told."""
    lean = np.maximum(np.abs(first[:, AT["trunk_flexion"]]), np.abs(first[:, AT["trunk_side"]]))
    neck = first[lean <= UPRIGHT_DEG, AT["neck_flexion"]]
    neck = neck[np.isfinite(neck)]
    return float(np.deg2rad(np.median(neck))) if neck.size and neck.size >= ENOUGH * len(first) else None


def _told_rad(block: Any) -> float | None:
    return neutral_told_rad(first_measures(block)) if has_body(block) else None


def _median(told_rad: list[float | None]) -> float:
    found = [angle for angle in told_rad if angle is not None]
    return float(np.median(found)) if found else 0.0


def _kin(model: Any, block: Any) -> tuple[Any, ...]:
    """Tasks of which this is the same have heads with the same markers."""
    if not has_body(block):
        return ("no body",)
    return tuple(block.skeleton.names), str(getattr(getattr(model, "report", None), "source", ""))
