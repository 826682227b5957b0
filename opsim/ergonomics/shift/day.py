"""All that workers' bodies did in the window, posture by posture: one pass over the rows of a log.

Only what was really done counts. Each performance is drawn again by its name (worker, task, k) and looked at once; each
piece of it is looked at where its progress lies and takes the time it took. Whatever asks what bodies went through
is a fold over these frames.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from opsim.ergonomics.columns import COLUMNS
from opsim.ergonomics.neutral import neck_neutrals_rad
from opsim.ergonomics.pieces import Pieces, pieces_of, worked_rows
from opsim.ergonomics.shift.parts import Parts, Spans, assembled, whole
from opsim.ergonomics.shift.seen import Seen
from opsim.ergonomics.shift.standing import STANDING
from opsim.ergonomics.shift.stretch import WAITING, Frames
from opsim.ergonomics.shift.walks_seen import WalksSeen
from opsim.ergonomics.strain.holds import marked
from opsim.ergonomics.strain.repetition import repeated_rows
from opsim.log import WAIT, EventLog
from opsim.one_thread import one_blas_thread
from opsim.plan import Plan

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
