"""The postures of one worker's walks: of many, a few are looked at and stand for those of about their length."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.ergonomics.measures import has_body, measures_of
from opsim.ergonomics.neutral import neck_neutral_rad
from opsim.ergonomics.pieces import Pieces
from opsim.ergonomics.shift.carried import carries
from opsim.ergonomics.shift.parts import Parts, Spans, looked_at, not_looked_at
from opsim.ergonomics.shift.stretch import WALKING
from opsim.ergonomics.walking import said_by, stood_for
from opsim.ergonomics.walks import drawable, drawn_walks
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.plan.walking import WalkingPlan
from opsim.streams import BLOCK, stream
from opsim.walks import Walks, walk_rows, walks_of

USUAL_WALK = {"distance_m": np.full(BLOCK, 5.0), "speed_m_per_s": np.full(BLOCK, 1.2)}
"""Walks by which it is told how heads are carried."""


class WalksSeen:
    """The walks of a log, those of one worker at a time: ``LOOKED_AT`` of each are looked at, once."""

    def __init__(self, log: EventLog, plan: Plan):
        assert plan.walking is not None
        self._plan, self._replication = plan, log.replication
        self._walks, self._row = walks_of(log, plan), walk_rows(log)
        self._carries = carries(log, plan, self._row)
        self._neutral_rad = _neutral_rad(plan.walking)
        self._rank, self._measures = -1, dict[int, np.ndarray]()

    def spans(self, rank: int, low_s: float, high_s: float) -> tuple[Spans, np.ndarray]:
        """One worker's walks between two times; and (P,) the number of each among all walks."""
        walks = self._walks
        mine = (walks.worker == rank) & (np.minimum(walks.end_s, high_s) > np.maximum(walks.start_s, low_s))
        which = np.flatnonzero(mine)
        begin_s, whole_s = walks.start_s[which], walks.whole_s[which]
        start_s, end_s = np.maximum(begin_s, low_s), np.minimum(walks.end_s[which], high_s)
        first, last = ((at_s - begin_s) / whole_s for at_s in (start_s, end_s))
        task = np.full(which.size, WALKING)
        pieces = Pieces(walks.worker[which], task, walks.k[which], first, np.minimum(last, 1.0), end_s - start_s)
        return Spans(self._row[which], start_s, pieces), which

    def parts(self, spans: Spans, which: np.ndarray) -> list[Parts]:
        """The frames of some walks of one worker, which ``spans`` gave."""
        if not which.size:
            return []
        measures = self._of(int(self._walks.worker[which[0]]))
        stands_in = self._stand_in(which, np.array(list(measures), dtype=int))
        full, unknown = self._carries[which], np.flatnonzero(stands_in < 0)
        found = [not_looked_at(spans, unknown, full[unknown])]
        for walk, filled in sorted(set(zip(stands_in[stands_in >= 0].tolist(), full[stands_in >= 0].tolist()))):
            these = np.flatnonzero((stands_in == walk) & (full == filled))
            hands = (np.zeros(1) if filled else np.ones(1)), np.ones(1)
            found.append(looked_at(spans, these, measures[walk], np.zeros(these.size, int), hands))
        return found

    def _stand_in(self, which: np.ndarray, looked: np.ndarray) -> np.ndarray:
        """(P,) the walk of nearly the same length that is looked at; -1 where a walk cannot be drawn."""
        assert self._plan.walking is not None
        can = drawable(self._plan.walking.model, self._walks.distance_m[which])
        if not looked.size:
            return np.full(which.size, -1)
        apart = np.abs(np.log(self._walks.distance_m[which][:, None] / self._walks.distance_m[looked]))
        own = which[:, None] == looked
        nearest = looked[np.argmin(np.where(own, -1.0, apart), axis=1)]
        return np.where(can, nearest, -1)

    def _of(self, rank: int) -> dict[int, np.ndarray]:
        """By the number of each walk of a worker that is looked at: measures (1, C, COLUMNS)."""
        if self._rank != rank:
            self._rank, self._measures = rank, dict(self._look(rank))
        return self._measures

    def _look(self, rank: int) -> list[tuple[int, np.ndarray]]:
        walking, walks = self._plan.walking, self._walks
        assert walking is not None
        low, high = self._plan.window_s
        inside_s = np.clip(walks.end_s, low, high) - np.clip(walks.start_s, low, high)
        wanted = (walks.worker == rank) & drawable(walking.model, walks.distance_m)
        looked = stood_for(walks, np.where(wanted, inside_s, 0.0)) > 0
        found = []
        with said_by(walking.name):
            for rows, block in drawn_walks(walks, self._plan, self._replication, looked):
                found += [(int(row), self._measured(block, walks, row)) for row in rows[looked[rows]]]
        return [(walk, measures) for walk, measures in found if measures is not None]

    def _measured(self, block: Any, walks: Walks, walk: int) -> np.ndarray | None:
        if not has_body(block):
            return None
        row = np.array([walks.k[walk] % BLOCK])
        if hasattr(type(block), "__getitem__"):
            block, row = block[row], np.array([0])
        return np.asarray(measures_of(block, row, self._plan.ergonomics, self._neutral_rad), np.float32)


def _neutral_rad(walking: WalkingPlan) -> float:
    return neck_neutral_rad(walking.model.sample(BLOCK, stream(0, 0, "neutral", 0), condition=USUAL_WALK))
