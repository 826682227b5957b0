"""The scores of a stretch of somebody's shift: each frame with what the scenario says of its task.

The postures of one worker's performances, each looked at once: what comes again later is kept until then.

All that workers' bodies did in the window, posture by posture: one pass over the rows of a log.

Only what was really done counts. Each performance is drawn again by its name (worker, task, k) and looked at once; each
piece of it is looked at where its progress lies and takes the time it took. Whatever asks what bodies went through
is a fold over these frames.

One pass over what bodies did, for all who ask something of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import Any, NamedTuple, Protocol

import numpy as np

from opsim.ergonomics.angles import COLUMNS
from opsim.ergonomics.measures import has_body, measures_of
from opsim.ergonomics.redraw import Lucks, Pieces, drawn_again, neck_neutrals_rad, pieces_of, worked_rows
from opsim.ergonomics.scores.scoring import NOTHING_OPEN, Bounds, Scores, bounds_of, score
from opsim.ergonomics.shift.frames import (
    STANDING,
    WAITING,
    WALKING,
    Frames,
    Parts,
    Spans,
    assembled,
    looked_at,
    not_looked_at,
    not_seen,
    whole,
)
from opsim.ergonomics.shift.walks import WalksSeen, carried_by
from opsim.ergonomics.strain.posture_limits import repeated_rows
from opsim.ergonomics.strain.static_holds import marked
from opsim.ergonomics.trunk import named_by
from opsim.log import WAIT, EventLog
from opsim.plan import Plan
from opsim.streams import BLOCK
from opsim.subjects.exposure.plan import Handling
from opsim.subjects.tools.plan import Moment
from opsim.threads import one_blas_thread


def scored(frames: Frames, plan: Plan) -> Scores:
    """The scores of N frames by ``plan.ergonomics``; 0 where no posture is known, so that nothing can be said."""
    n, known = len(frames), frames.known
    rula, reba, owas = np.zeros((3, n, 2), np.int8)
    found = Scores(rula, reba, owas, np.zeros(n, np.int8))
    brought = np.where((frames.task == WALKING) & frames.carrying, frames.product, -1)
    for task, product in sorted(set(zip(frames.task[known].tolist(), brought[known].tolist()))):
        rows = np.flatnonzero(known & (frames.task == task) & (brought == product))
        some = frames.some(rows)
        flags = (some.repeated, some.static, some.carrying)
        own = score(some.measures, said_of(task, plan, product, frames.worker), plan.ergonomics, *flags)
        for name in ("rula", "reba", "owas", "worse"):
            getattr(found, name)[rows] = getattr(own, name)
    return found


def said_of(task: int, plan: Plan, product: int = -1, worker: int = 0) -> Bounds:
    """What is said of a task; of walking, with a job of a product in the worker's hands where there is one; and of
    waiting, which is standing with nothing in the hands."""
    if task >= 0:
        return bounds_of(plan.tasks[task].handling)
    return NOTHING_OPEN if task == WAITING else carried_by(plan, worker, product)


class Looked(NamedTuple):
    """Performances looked at: measures (m, C, COLUMNS), and (m,) from and to which progress hands may be full."""

    measures: np.ndarray
    begin: np.ndarray
    end: np.ndarray

    def one(self, place: int) -> Looked:
        """One of them, by itself; NOTE: a copy, so that it does not keep the others."""
        return Looked(*(column[place : place + 1].copy() for column in self))


class Seen:
    """Looks at pieces of one worker, stretch after stretch, block by block of his draws."""

    def __init__(self, plan: Plan, replication: int, neutrals_rad: dict[str, float], lucks: Lucks):
        self._plan, self._replication = plan, replication
        self._neutrals_rad, self._lucks = neutrals_rad, lucks
        self._kept: dict[tuple[int, int], Looked] = {}

    def parts(self, spans: Spans, again: np.ndarray) -> Iterator[Parts]:
        """Frames of some pieces of work; again : (P,) whether the performance of each goes on after this stretch."""
        kept = np.array([key in self._kept for key in _keys(spans.pieces)], dtype=bool)
        yield from self._seen_before(spans, np.flatnonzero(kept), again)
        new = np.flatnonzero(~kept)
        new, at = new[np.lexsort([spans.pieces.k[new], spans.pieces.task[new]])], 0
        for block, some in drawn_again(spans.pieces.some(new), self._replication, self._plan, self._lucks):
            which = new[at : at + some.k.size]
            at += some.k.size
            if has_body(block):
                yield self._seen_now(spans, which, block, again)
            else:
                handling = self._plan.tasks[int(some.task[0])].handling
                if handling.by_share:
                    yield not_seen(spans, which, (handling.start.share, handling.end.share))
                else:
                    yield not_looked_at(spans, which)

    def _seen_before(self, spans: Spans, which: np.ndarray, again: np.ndarray) -> Iterator[Parts]:
        for at, key in zip(which.tolist(), _keys(spans.pieces.some(which))):
            looked = self._kept[key]
            yield looked_at(spans, np.array([at]), looked.measures, np.array([0]), (looked.begin, looked.end))
        for at, key in zip(which.tolist(), _keys(spans.pieces.some(which))):
            if not again[at]:
                self._kept.pop(key, None)

    def _seen_now(self, spans: Spans, which: np.ndarray, block: Any, again: np.ndarray) -> Parts:
        pieces = spans.pieces.some(which)
        numbers, first, place = np.unique(pieces.k, return_index=True, return_inverse=True)
        looked = self._look(block, int(pieces.task[0]), numbers % BLOCK)
        for at in np.flatnonzero(again[which[first]]).tolist():
            self._kept[int(pieces.task[0]), int(numbers[at])] = looked.one(at)
        return looked_at(spans, which, looked.measures, place, (looked.begin, looked.end))

    def _look(self, block: Any, task: int, rows: np.ndarray) -> Looked:
        named = self._plan.tasks[task]
        with named_by(named):
            measures = measures_of(block, rows, self._plan.ergonomics, self._neutrals_rad[named.name])
        return Looked(np.asarray(measures, np.float32), *hands_full(named.handling, block, rows))


def _keys(pieces: Pieces) -> Iterator[tuple[int, int]]:
    """Task and k of each: which performance of the worker."""
    return zip(pieces.task.tolist(), pieces.k.tolist())


def hands_full(handling: Handling, block: Any, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m,) and (m,) from and to which share of their time hands hold what is handled, in some rows of a block."""
    return _share(handling.start, block, rows), _share(handling.end, block, rows)


def _share(moment: Moment, block: Any, rows: np.ndarray) -> np.ndarray:
    if moment.mark < 0:
        return np.full(rows.size, moment.share)
    return np.asarray(block.mark_s)[rows, moment.mark] / np.asarray(block.duration_s)[rows]


UPRIGHT = "upright"
HOUR_S = 3600.0


def days(log: EventLog, plan: Plan) -> Iterator[Frames]:
    """Worker after worker, his frames in the order of time, in stretches within an hour of the clock.

    Work and set-ups always; walking where the plan names its emulator; waiting where ``plan.ergonomics.waiting`` says
    how people stand. The seconds of a piece's frames sum to its own in the window. Stretches without a frame are left
    out. No more than some two hours of one worker are held at a time.
    Raises ValueError, naming the task, where its model gives postures of a shape it should not; whatever goes wrong in
    a plug-in is a PluginError.
    """
    for frames, held in marked(_unmarked(log, plan)):
        frames.static[:] = held.any(axis=1)
        yield frames


def _unmarked(log: EventLog, plan: Plan) -> Iterator[Frames]:
    """The same, before it is known which postures are held."""
    looking = _Looking(log, plan)
    edges_s = hours_s(plan)
    for rank in range(len(plan.workers)):
        looking.begin(rank)
        for low_s, high_s in pairwise(edges_s):
            with one_blas_thread():
                frames = looking.between(low_s, high_s)
            if frames is not None:
                yield frames


def hours_s(plan: Plan) -> list[float]:
    """Beginning and end of the window, and the full hours of the clock between them."""
    low, high = plan.window_s
    first = int((plan.start_s + low) // HOUR_S) + 1
    last = int(np.ceil((plan.start_s + high) / HOUR_S))
    return [low, *(HOUR_S * hour - plan.start_s for hour in range(first, last)), high]


class _Looking:
    """Looks at what one worker after the other does."""

    def __init__(self, log: EventLog, plan: Plan):
        self._log, self._plan = log, plan
        self._repeated = repeated_rows(log)
        self._neutrals_rad = neck_neutrals_rad({task.name: task.model for task in plan.tasks})
        self._walks = None if plan.walking is None else WalksSeen(log, plan)
        rows = worked_rows(log, *plan.window_s)
        self._rows = rows[np.argsort(log["start_s"][rows], kind="stable")]
        self._worker = log["worker"][self._rows]
        self._until_s = _until_s(log, self._rows)
        self._rank = -1

    def begin(self, rank: int) -> None:
        """The next worker."""
        self._rank, self._seen = rank, Seen(self._plan, self._log.replication, self._neutrals_rad, {})
        mine = self._worker == rank
        self._own, self._own_until_s = self._rows[mine], self._until_s[mine]

    def between(self, low_s: float, high_s: float) -> Frames | None:
        """His frames between two times; None where there is none."""
        found = [*self._work(low_s, high_s), *self._walked(low_s, high_s), *self._waited(low_s, high_s)]
        return assembled(self._log, self._rank, found, self._repeated)

    def _work(self, low_s: float, high_s: float) -> Iterator[tuple[Spans, Parts]]:
        log = self._log
        inside = np.minimum(log["end_s"][self._own], high_s) > np.maximum(log["start_s"][self._own], low_s)
        rows, again = self._own[inside], self._own_until_s[inside] > high_s
        spans = Spans(rows, np.maximum(log["start_s"][rows], low_s), pieces_of(log, rows, low_s, high_s))
        yield from ((spans, parts) for parts in self._seen.parts(spans, again))

    def _walked(self, low_s: float, high_s: float) -> Iterator[tuple[Spans, Parts]]:
        if self._walks is not None:
            spans, which = self._walks.spans(self._rank, low_s, high_s)
            yield from ((spans, parts) for parts in self._walks.parts(spans, which))

    def _waited(self, low_s: float, high_s: float) -> Iterator[tuple[Spans, Parts]]:
        if self._plan.ergonomics.waiting != UPRIGHT:
            return
        log = self._log
        inside = np.minimum(log["end_s"], high_s) > np.maximum(log["start_s"], low_s)
        rows = np.flatnonzero(inside & (log["kind"] == WAIT) & (log["worker"] == self._rank))
        start_s, end_s = np.maximum(log["start_s"][rows], low_s), np.minimum(log["end_s"][rows], high_s)
        nothing = np.zeros(rows.size)
        task = np.full(rows.size, WAITING)
        spans = Spans(rows, start_s, Pieces(log["worker"][rows], task, task, nothing, nothing, end_s - start_s))
        standing = np.broadcast_to(STANDING, (rows.size, len(COLUMNS)))
        yield spans, whole(spans, np.arange(rows.size), standing, carrying=False)


def _until_s(log: EventLog, rows: np.ndarray) -> np.ndarray:
    """(n,) when the last piece of the performance of each of some rows of work ends."""
    order = np.lexsort([log[name][rows] for name in ("k", "task", "worker")])
    named = np.array([log[name][rows[order]] for name in ("worker", "task", "k")])
    number = np.cumsum(np.r_[True, (named[:, 1:] != named[:, :-1]).any(axis=0)][: order.size]) - 1
    last_s = np.zeros(order.size)
    np.maximum.at(last_s, number, log["end_s"][rows[order]])
    until_s = np.empty(order.size)
    until_s[order] = last_s[number]
    return until_s


class Fold(Protocol):
    """Whoever looks at every stretch once: worker after worker, each in the order of time."""

    def add(self, frames: Frames, scores: Scores) -> None:
        """The next stretch; it lies within an hour of the clock."""


def fold(log: EventLog, plan: Plan, folds: Iterable[Fold]) -> None:
    """Show every stretch of a replication, with its scores, to all of ``folds``. Raises what ``days`` raises."""
    folds = list(folds)
    with one_blas_thread():
        for frames in days(log, plan):
            scores = scored(frames, plan)
            for one in folds:
                one.add(frames, scores)
