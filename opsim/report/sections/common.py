"""Shares of the time for which the floor is open, from shares of all that is counted, nights and weekends with it.

Stations in the order in which jobs come to them, so that a figure of all of them reads along the flow.

Parts of figures: in words, and those that tables leave out because there was nothing of them, or nothing new.

How long people were where, in the window of one replication: at places, and on the ways between them.

Who walked between which two places, how often and how far, in the window of one replication.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.history import NOWHERE, on_grid_each, ways_m, whereabouts
from opsim.kpi.parts import PART_NAMES
from opsim.kpi.window import SECONDS_PER_HOUR, duty_hours, in_window, inside_s, open_hours, open_time_s, window_length_s
from opsim.log import REPAIR, SETUP, WALK, WORK, EventLog
from opsim.plan import Plan
from opsim.report.numbers import is_number
from opsim.subjects.routes.plan import ProductPlan
from opsim.subjects.shifts.hours import floor_has_hours, scheduled
from opsim.subjects.shifts.plan import either
from opsim.subjects.stations.plan import STATION

ENDS = ("mean", "low", "high", "half_width")
LEAST_H = 1e-6


def open_share(plan: Plan, active: float = 0.0) -> float:
    """Of the window, for which the floor is scheduled to be open; 1 where it keeps no hours, or none lie in the window.

    active : share of the window in which something was done, overtime too; the share is never less
    """
    share = open_hours(plan) * SECONDS_PER_HOUR / window_length_s(plan) if floor_has_hours(plan) else 1.0
    return min(1.0, max(share, active)) or 1.0


def of_open(row: Mapping[str, Any], share: float) -> dict[str, Any]:
    """A row of a figure that is a share of the window, as one of the open time."""
    return {**row, **{end: row[end] / share for end in ENDS if is_number(row.get(end))}}


def staffed_h(plan: Plan) -> float:
    """Hours of the window in which the floor is scheduled to be open or somebody is meant to be there; all of them
    where there are none."""
    spans = either(scheduled(plan), *(duty_hours(plan, rank) for rank in range(len(plan.workers))))
    return open_time_s(plan, spans) / SECONDS_PER_HOUR or window_length_s(plan) / SECONDS_PER_HOUR


def with_closed(plan: Plan) -> str:
    """`` of the 48 h counted, closed ones too``, where the window has hours in which nobody is meant to be there."""
    counted_h = window_length_s(plan) / SECONDS_PER_HOUR
    return f" of the {counted_h:g} h counted, closed ones too" if staffed_h(plan) < counted_h - LEAST_H else ""


def flow_order(plan: Plan) -> list[int]:
    """Ranks of all points of the flow: product by product, what goes into another ahead of it, each from its first
    step on; a station that only some products visit stands behind the one they come from. What is on no route, such as
    where rework is done, comes last in natural order.
    """
    found: list[int] = []
    for product in _parts_first(plan):
        way = along(plan.products[product])
        behind = next((found.index(rank) for rank in way if rank in found), len(found))
        for rank in way:
            if rank in found:
                behind = found.index(rank) + 1
            else:
                found.insert(behind, rank)
                behind += 1
    return list(dict.fromkeys([*found, *range(len(plan.stations))]))


def worked_on(plan: Plan) -> list[int]:
    """Those of them where jobs get work."""
    return [rank for rank in flow_order(plan) if plan.stations[rank].kind == STATION and plan.stations[rank].tasks]


def along(product: ProductPlan) -> list[int]:
    """Ranks of the points on a route, or of a network by the fewest steps to them, each once."""
    steps = [step for _, step in product.start if step >= 0]
    for step in steps:  # grows as it goes
        steps += [onward for _, onward in product.onward[step] if onward >= 0 and onward not in steps]
    return list(dict.fromkeys(rank for step in steps for rank in product.route[step].stations))


def _parts_first(plan: Plan) -> list[int]:
    """Ranks of the products, those that go into another one ahead of it."""
    found: list[int] = []

    def add(product: int, above: frozenset[int]) -> None:
        parts = sorted({part for kit in plan.kits if kit.product == product for part, _ in kit.parts})
        for part in parts:
            if part not in above:
                add(part, above | {part})
        found.append(product)

    for product in range(len(plan.products)):
        add(product, frozenset({product}))
    return list(dict.fromkeys(found))


Row = Mapping[str, Any]
AT_MOST = "at_most"
SHOWN_WHERE_ANY = tuple(PART_NAMES)
"""Figures of which only the total, and the parts that are there at all, are shown."""

BY_PART = (
    *("exposure_gini", "static_hold_min_per_h", "longest_hold_s", "iso_11226_min_per_h", "en_1005_4_min_per_h"),
    *("movements_per_min", "rest_allowance_share"),
)
"""Those of them that have parts alone: nothing but their parts can say that there was nothing, and 0 is an answer."""


def is_shown(kpi: str, part: str, rows: Iterable[Row]) -> bool:
    """Whether a part is shown; rows : of the summary, one a variant. No part of these figures is below 0."""
    if kpi in BY_PART:
        return any(row["mean"] is not None for row in rows)
    return kpi not in SHOWN_WHERE_ANY or not part or any((row["mean"] or 0) > 0 for row in rows)


def says_again(part: str, rows: Sequence[Row], beside: Mapping[str, Sequence[Row]]) -> bool:
    """Whether a part is how much there may be at most of another one, and no other in any variant.

    rows : of the part, one a variant; beside : those of all parts of the same subject
    """
    if not part.endswith(AT_MOST):
        return False
    least = beside.get(part.removesuffix(AT_MOST).removesuffix("_"))
    return least is not None and [_said(row) for row in least] == [_said(row) for row in rows]


def without_again(rows: Sequence[Row]) -> list[Row]:
    """The rows of one variant but those that ``says_again`` finds."""
    found: dict[tuple[str, str], dict[str, Sequence[Row]]] = {}
    for row in rows:
        found.setdefault((row["kpi"], row["subject"]), {})[row.get("part", "")] = [row]
    return [row for row in rows if not says_again(row.get("part", ""), [row], found[row["kpi"], row["subject"]])]


def _said(row: Row) -> tuple[Any, ...]:
    return tuple(row.get(key) for key in ("mean", "low", "high", "n"))


@dataclass(frozen=True)
class Presence:
    """Seconds of all workers together in an hour of those in which the floor is open or somebody on duty.

    at_place : (P,) at each place; work : (P,) of it at work; on_way : {(from, to): seconds} between different places
    """

    at_place: np.ndarray
    work: np.ndarray
    on_way: dict[tuple[int, int], float]

    @property
    def walking(self) -> float:
        """Seconds on ways."""
        return sum(self.on_way.values())

    @property
    def total(self) -> float:
        """Seconds on the floor; who is off or absent is not there."""
        return float(self.at_place.sum()) + self.walking


def presence(log: EventLog, plan: Plan) -> Presence:
    """Of the rows of one replication."""
    seen = whereabouts(log, plan)
    low_s, high_s = plan.window_s
    spent = np.clip(seen.end_s, low_s, high_s) - np.clip(seen.start_s, low_s, high_s)
    spent /= staffed_h(plan)
    there = (seen.place_from != NOWHERE) & (seen.place_to != NOWHERE)
    stays = there & (seen.place_from == seen.place_to)
    works = stays & np.isin(seen.kind, (WORK, SETUP, REPAIR))
    n = len(plan.places)
    at_place, work = (np.bincount(seen.place_from[rows], weights=spent[rows], minlength=n) for rows in (stays, works))
    goes = there & ~stays & (spent > 0)
    pairs, which = np.unique(seen.place_from[goes] * n + seen.place_to[goes], return_inverse=True)
    seconds = np.bincount(which, weights=spent[goes], minlength=pairs.size)
    on_way = {divmod(pair, n): lasts for pair, lasts in zip(pairs.tolist(), seconds.tolist())}
    return Presence(at_place, work, on_way)


Pair = tuple[int, int, float, float]
"""(place, place, trips an hour, metres an hour)"""


@dataclass(frozen=True)
class WalkedWays:
    """A row for each worker and pair of places, both ways together, (n,) each.

    worker, low, high : ranks; low < high, or the same where somebody walks along with a moving line
    trips_per_h : those that end in the window, as ``trips_per_h`` of the figures counts them; metres_per_h : as
        ``walked_m``; both in an hour of the window
    """

    worker: np.ndarray
    low: np.ndarray
    high: np.ndarray
    trips_per_h: np.ndarray
    metres_per_h: np.ndarray

    def where(self, mask: np.ndarray) -> WalkedWays:
        """Some of the rows."""
        return WalkedWays(*(column[mask] for column in vars(self).values()))

    def by_pair(self) -> list[Pair]:
        """All workers together, the most metres first; ways of no length are none."""
        apart = self.where(self.low != self.high)
        (low, high), which = _groups(apart.low, apart.high)
        trips = np.bincount(which, weights=apart.trips_per_h, minlength=low.size)
        metres = np.bincount(which, weights=apart.metres_per_h, minlength=low.size)
        found: list[Pair] = list(zip(low.tolist(), high.tolist(), trips.tolist(), metres.tolist()))
        return sorted(found, key=lambda one: (-one[3], -one[2], one[0], one[1]))

    def by_worker(self, n: int) -> np.ndarray:
        """(n,) metres an hour of each worker."""
        return np.bincount(self.worker, weights=self.metres_per_h, minlength=n)

    def shares(self, low: int, high: int) -> Iterator[tuple[int, float]]:
        """(worker, share of the trips between two places), the largest first."""
        own = self.where((self.low == low) & (self.high == high))
        total = float(own.trips_per_h.sum())
        for at in np.argsort(-own.trips_per_h, kind="stable").tolist():
            yield int(own.worker[at]), float(own.trips_per_h[at] / total) if total else 0.0


def walked_ways(log: EventLog, plan: Plan) -> WalkedWays:
    """Of the rows of one replication."""
    rows = np.flatnonzero((log["kind"] == WALK) & (log["worker"] >= 0))
    worker, start, end = (log[name][rows].astype(np.int64) for name in ("worker", "place_from", "place_to"))
    speed = np.array([person.walk_m_per_s for person in plan.workers])[worker]
    way_m = ways_m(log, plan, rows, speed)
    metres = way_m * np.minimum(1.0, inside_s(log, rows, plan) / on_grid_each(way_m / speed))
    ended = in_window(log["end_s"][rows], plan) & (start != end)
    (who, low, high), which = _groups(worker, np.minimum(start, end), np.maximum(start, end))
    hours, n = window_length_s(plan) / SECONDS_PER_HOUR, who.size
    trips = np.bincount(which, weights=ended, minlength=n) / hours
    metres_per_h = np.bincount(which, weights=metres, minlength=n) / hours
    some = (trips > 0) | (metres_per_h > 0)
    return WalkedWays(who[some], low[some], high[some], trips[some], metres_per_h[some])


def _groups(*columns: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """(columns of what is different, in order; which of it each row is). columns : (R,) numbers from 0"""
    sizes = tuple(int(column.max(initial=0)) + 1 for column in columns)
    keys, which = np.unique(np.ravel_multi_index(columns, sizes), return_inverse=True)  # one number each: quick to sort
    return list(np.unravel_index(keys, sizes)), which
