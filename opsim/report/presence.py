"""How long people were where, in the window of one replication: at places, and on the ways between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.log import REPAIR, SETUP, WORK, EventLog
from opsim.plan import Plan
from opsim.report.open_time import staffed_h
from opsim.whereabouts import NOWHERE, whereabouts


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
