"""Which station holds up the floor, moment by moment."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.active import Periods, active_periods
from opsim.kpi.figure import Figure
from opsim.kpi.values import window_length_s
from opsim.log import EventLog
from opsim.plan import Plan


def bottleneck(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each station the shares of the window in which it is the bottleneck.

    momentary : its active period is the longest of those under way; with ``none`` (nobody active) these sum to 1
    sole      : it is so, and no period of another station that is the longest at some other moment overlaps
    shifting  : such a period of its own overlaps with one of another station: the bottleneck moves
    Of the whole: shifting (somewhere) and none; with the sole shares these sum to 1.
    Source: Roser, Nakano & Tanaka 2002, Shifting bottleneck detection, Winter Simulation Conference, 1079-1086.
    """
    periods, n = active_periods(log, plan), len(plan.stations)
    edges_s, longest = longest_under_way(periods)
    seconds = np.diff(np.clip(edges_s, *plan.window_s))
    anyone = longest >= 0
    chosen = np.unique(longest[anyone])
    overlapping = _n_under_way(edges_s, periods.start_s[chosen], periods.end_s[chosen])
    alone = overlapping == 1
    momentary_s = np.bincount(periods.station[longest[anyone]], seconds[anyone], n)
    sole_s = np.bincount(periods.station[longest[alone]], seconds[alone], n)
    chosen_s = np.diff(np.clip([periods.start_s[chosen], periods.end_s[chosen]], *plan.window_s), axis=0)[0]
    parts = {"momentary": momentary_s, "sole": sole_s}
    parts["shifting"] = np.maximum(np.bincount(periods.station[chosen], chosen_s, n) - sole_s, 0.0)
    length_s = window_length_s(plan)
    for rank, station in enumerate(plan.stations):
        for part, spent_s in parts.items() if station.tasks else ():
            yield Figure("bottleneck", station.name, part, "share", spent_s[rank] / length_s)
    yield Figure("bottleneck", "", "shifting", "share", seconds[overlapping > 1].sum() / length_s)
    yield Figure("bottleneck", "", "none", "share", 1.0 - seconds[anyone].sum() / length_s)


def longest_under_way(periods: Periods) -> tuple[np.ndarray, np.ndarray]:
    """Edges (M + 1,) in seconds between which nothing begins or ends, and (M,) the longest period there, -1 for none.

    Of equally long ones the station of the smaller rank is taken. Each period is laid over its stretches as two blocks
    of the largest power of two that fits; then blocks are halved, level by level, and the longer one stays on top.
    """
    order = np.lexsort([-periods.station, periods.end_s - periods.start_s])
    edges_s = np.unique(np.r_[periods.start_s, periods.end_s])
    first, last = np.searchsorted(edges_s, periods.start_s[order]), np.searchsorted(edges_s, periods.end_s[order])
    level = np.frexp(last - first)[1] - 1
    top = np.full(max(edges_s.size - 1, 0), -1)
    for power in range(int(level.max(initial=0)), -1, -1):
        block = 2**power
        below = top.copy()
        np.maximum(below[block:], top[:-block], out=below[block:])
        top = below
        here = np.flatnonzero(level == power)
        np.maximum.at(top, first[here], here)
        np.maximum.at(top, last[here] - block, here)
    return edges_s, np.where(top >= 0, np.append(order, -1)[top], -1)


def _n_under_way(edges_s: np.ndarray, start_s: np.ndarray, end_s: np.ndarray) -> np.ndarray:
    """(M,) how many of some periods are under way between each two edges."""
    steps = [np.bincount(np.searchsorted(edges_s, at_s), minlength=edges_s.size) for at_s in (start_s, end_s)]
    return np.cumsum(steps[0] - steps[1])[:-1]
