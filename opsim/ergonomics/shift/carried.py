"""What is in the hands of those who walk: the jobs of products that are carried; else nothing.

A row of a walk names the job it is about; the job's own rows say whether it was on its way then. Of a lot that takes
several ways, every other one is the way back, with empty hands. Tools and what else people may bring are not counted.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from opsim.ergonomics.scores.bounds import Bounds, bounds_of
from opsim.log import TRANSPORT, EventLog
from opsim.plan import Plan
from opsim.plan.handling import Handling

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
