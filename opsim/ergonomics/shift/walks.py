"""What is in the hands of those who walk: the jobs of products that are carried; else nothing.

A row of a walk names the job it is about; the job's own rows say whether it was on its way then. Of a lot that takes
several ways, every other one is the way back, with empty hands. Tools and what else people may bring are not counted.

The postures of one worker's walks: of many, a few are looked at and stand for those of about their length.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from opsim.ergonomics.measures import has_body, measures_of
from opsim.ergonomics.redraw import Pieces, neck_neutral_rad
from opsim.ergonomics.scores.scoring import Bounds, bounds_of
from opsim.ergonomics.shift.frames import WALKING, Parts, Spans, looked_at, not_looked_at
from opsim.ergonomics.walking import drawable, drawn_walks, said_by, stood_for
from opsim.history import Walks, walk_rows, walks_of
from opsim.log import TRANSPORT, EventLog
from opsim.plan import Plan
from opsim.streams import BLOCK, stream
from opsim.subjects.exposure.plan import Handling
from opsim.subjects.people.plan import WalkingPlan

EMPTY_HANDS = "who walks has empty hands, but for the job of a product that is carried, held without a shock"
"""For the assumption sheet."""


def carries(log: EventLog, plan: Plan, rows: np.ndarray) -> np.ndarray:
    """(R,) whether each of some walks brings a job; rows : (R,) of the log, by worker and time."""
    found = np.zeros(rows.size, bool)
    product = log["product"][rows]
    may = np.flatnonzero((log["job"][rows] >= 0) & (product >= 0))
    may = may[np.array([one.carried for one in plan.products], bool)[product[may]]]
    moved = np.flatnonzero((log["kind"] == TRANSPORT) & (log["job"] >= 0))
    way = _way(log, rows[may], moved)
    may, way = may[way >= 0], way[way >= 0]
    found[may] = _how_manyth(way) % 2 == 0
    return found


def _way(log: EventLog, walks: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """(n,) place among ``moved`` of the row in which the job of each walk is on its way; -1 where it is not."""
    both = np.r_[moved, walks]
    order = np.lexsort([np.arange(both.size) >= moved.size, log["start_s"][both], log["job"][both]])
    latest = np.maximum.accumulate(np.where(order < moved.size, np.arange(order.size), -1))
    last = np.empty(order.size, np.int64)
    last[order] = np.where(latest >= 0, order[latest], -1)
    way = last[moved.size :]
    if not moved.size:
        return way
    row = moved[way]
    same = (way >= 0) & (log["job"][row] == log["job"][walks])
    return np.where(same & (log["end_s"][row] >= log["end_s"][walks]), way, -1)


def _how_manyth(way: np.ndarray) -> np.ndarray:
    """(n,) how many walks of the same way come before each; walks in the order of time."""
    order = np.argsort(way, kind="stable")
    begins = np.flatnonzero(np.r_[True, np.diff(way[order]) != 0][: order.size])
    count = np.empty(order.size, np.int64)
    count[order] = np.arange(order.size) - np.repeat(begins, np.diff(np.r_[begins, order.size]))
    return count


def carried_kg(plan: Plan, worker: int, product: int) -> float | None:
    """What somebody has in his hands who brings a job of a product: as many units as he may at once; the last way of a
    lot counts as full. None where the mass is not told."""
    one, most_kg = plan.products[product], plan.workers[worker].most_load_kg
    if one.mass_kg is None or one.mass_kg <= 0:
        return one.mass_kg
    at_once = one.lot if most_kg is None else max(1, int((most_kg + 1e-9) // one.mass_kg))
    return one.mass_kg * min(one.lot, at_once)


def carried_by(plan: Plan, worker: int, product: int) -> Bounds:
    """Who walks and brings a job of a product, -1 for one that is not known: its mass, held now and then or steadily
    and never with a shock, in any grip."""
    kg = carried_kg(plan, worker, product) if product >= 0 else None
    seldom, steady = (
        bounds_of(Handling(load_kg=kg, force=force), walking=True) for force in ("intermittent", "static")
    )
    spans: dict[str, Any] = {
        name: (getattr(seldom, name)[0], getattr(steady, name)[1]) for name in ("rula_force", "rula_force_worksheet")
    }
    return replace(seldom, **spans)


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
