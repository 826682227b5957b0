"""What stood on each server, and what each worker did, as stretches of time that a Gantt chart can draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.kpi.states import STATES, states_of_rows
from opsim.kpi.window import changes, closed_hours
from opsim.log import BATCH, BLOCKED, CAUSES, DOWN, HELD, SETUP, WORK, EventLog
from opsim.plan import Plan
from opsim.subjects.breakdowns.figures import outage_rows
from opsim.subjects.shifts.plan import both

STATE_OF = {WORK: "work", SETUP: "setup", BLOCKED: "blocked", HELD: "held"}
"""Kinds of rows of a job that is on a server."""
NOT_DRAWN = ("wait", "off")
"""States of workers that leave the chart white."""
HOUR_S = 3600.0
MOST_HOURS = 48


@dataclass(frozen=True, slots=True)
class Stretch:
    """What is in one place for some time. row : rank of the station or of the worker

    what : "work" of a job, or another state; job, product, station : -1 where there is none; cause : "" for none
    lane : of ``lanes`` that a row is cut into
    """

    row: int
    what: str
    start_s: float
    end_s: float
    job: int = -1
    product: int = -1
    station: int = -1
    lane: int = 0
    lanes: int = 1
    cause: str = ""


@dataclass(frozen=True, eq=False)
class Stretches:
    """Many of them as columns (N,), of which only those that are shown are made. what, cause : numbers of the words in
    ``states`` and of ``CAUSES``"""

    states: Sequence[str]
    columns: dict[str, np.ndarray]

    def _met(self, from_s: float, to_s: float) -> np.ndarray:
        return (self.columns["end_s"] > from_s) & (self.columns["start_s"] < to_s)

    def count(self, from_s: float, to_s: float) -> int:
        """How many meet some time."""
        return int(np.count_nonzero(self._met(from_s, to_s)))

    def between(self, from_s: float, to_s: float) -> list[Stretch]:
        """Those of some time, cut to it."""
        met = self._met(from_s, to_s)
        named = {name: column[met].tolist() for name, column in self.columns.items()}
        named["start_s"] = [max(from_s, at_s) for at_s in named["start_s"]]
        named["end_s"] = [min(to_s, at_s) for at_s in named["end_s"]]
        named["what"] = [self.states[number] for number in named["what"]]
        if "cause" in named:
            named["cause"] = [CAUSES[number] for number in named["cause"]]
        return [Stretch(**dict(zip(named, values))) for values in zip(*named.values())]


def typical_hour_s(log: EventLog, plan: Plan) -> tuple[float, float]:
    """The full hour of the clock after the warm-up whose work is nearest to the median of all that have some; the
    first of them; of a shorter window all."""
    low_s, high_s = plan.window_s
    first_s = (-(plan.start_s + low_s)) % HOUR_S + low_s
    starts_s = np.arange(first_s, high_s - HOUR_S + 1e-6, HOUR_S)[:MOST_HOURS]
    work = np.flatnonzero(log["kind"] == WORK)
    if not starts_s.size:
        return low_s, min(high_s, low_s + HOUR_S)
    clipped = (np.clip(log[edge][work][:, None], starts_s, starts_s + HOUR_S) for edge in ("end_s", "start_s"))
    worked_s = np.subtract(*clipped).sum(axis=0)
    some = worked_s > 0
    if not some.any():
        return float(starts_s[0]), float(starts_s[0]) + HOUR_S
    apart = np.where(some, np.abs(worked_s - np.median(worked_s[some])), np.inf)
    start_s = float(starts_s[int(np.argmin(apart))])
    return start_s, start_s + HOUR_S


def on_servers(log: EventLog, plan: Plan, from_s: float, to_s: float) -> Stretches:
    """Jobs on the servers of stations between two times, a state of a job one stretch.

    Jobs that stand on different servers at once have lanes of their own: never more than jobs fit on the servers. What
    waits for the rest of its batch stands with the first one, which is drawn.
    """
    kept = (log["job"] >= 0) & (log["station"] >= 0) & np.isin(log["kind"], list(STATE_OF))
    kept &= ~((log["kind"] == HELD) & (log["cause"] == BATCH))
    rows = np.flatnonzero(kept & _meets(log, from_s, to_s))
    rows = rows[np.lexsort([log["start_s"][rows], log["job"][rows], log["station"][rows]])]
    station, job, kind, cause = (log[name][rows] for name in ("station", "job", "kind", "cause"))
    start_s, end_s = log["start_s"][rows], log["end_s"][rows]
    stays = changes(station, job) | _gaps(start_s, end_s)
    begins = np.flatnonzero(stays | changes(kind, np.where(kind == HELD, cause, 0)))
    first = np.flatnonzero(stays)
    lane = _lanes(station[first], start_s[first], end_s[_lasts(first, rows.size)])
    lanes = np.array([max(1, point.servers) for point in plan.stations])
    np.maximum.at(lanes, station[first], lane + 1)
    number = np.zeros(max(STATE_OF) + 1, dtype=int)
    number[list(STATE_OF)] = range(len(STATE_OF))
    columns = {
        "row": station[begins],
        "what": number[kind[begins]],
        "start_s": start_s[begins],
        "end_s": end_s[_lasts(begins, rows.size)],
        "job": job[begins],
        "product": log["product"][rows[begins]],
        "station": station[begins],
        "lane": lane[(np.cumsum(stays) - 1)[begins]],
        "lanes": lanes[station[begins]],
        "cause": np.where(kind == HELD, cause, 0)[begins],
    }
    return Stretches(tuple(STATE_OF.values()), columns)


def _meets(log: EventLog, from_s: float, to_s: float) -> np.ndarray:
    """(rows,) whether any time of a row lies between two."""
    return (log["end_s"] > from_s) & (log["start_s"] < to_s) & (log["end_s"] > log["start_s"])


def _gaps(start_s: np.ndarray, end_s: np.ndarray) -> np.ndarray:
    """(N,) whether nothing was between a row and the one before."""
    return np.r_[True, start_s[1:] > end_s[:-1] + 1e-6][: start_s.size]


def _lasts(begins: np.ndarray, n: int) -> np.ndarray:
    """The last row of each group that begins somewhere."""
    return np.r_[begins[1:], n][: begins.size] - 1


def _lanes(station: np.ndarray, start_s: np.ndarray, end_s: np.ndarray) -> np.ndarray:
    """(N,) of each stay the first lane of its station that is free when it begins."""
    lane = np.zeros(start_s.size, dtype=int)
    free_s: dict[int, list[float]] = {}
    for n in np.lexsort([end_s, start_s, station]).tolist():
        ends_s = free_s.setdefault(int(station[n]), [])
        found = next((place for place, at_s in enumerate(ends_s) if at_s <= start_s[n] + 1e-6), len(ends_s))
        ends_s[found : found + 1] = [float(end_s[n])]
        lane[n] = found
    return lane


def standing(log: EventLog, plan: Plan, from_s: float, to_s: float) -> list[Stretch]:
    """Stations that are down, repaired or closed between two times; row : the station's rank."""
    rows = outage_rows(log)
    rows = rows[(log["end_s"][rows] > from_s) & (log["start_s"][rows] < to_s)]
    found = [
        Stretch(
            int(log["station"][n]),
            "down" if log["kind"][n] == DOWN else "repair",
            max(from_s, float(log["start_s"][n])),
            min(to_s, float(log["end_s"][n])),
            cause=CAUSES[log["cause"][n]],
        )
        for n in rows.tolist()
    ]
    for rank in range(len(plan.stations)):
        found += [Stretch(rank, "closed", *span) for span in both(closed_hours(plan, rank), ((from_s, to_s),))]
    return found


def of_workers(log: EventLog, from_s: float, to_s: float) -> Stretches:
    """What workers do between two times but for being idle or off; what is alike and meets is one."""
    rows, state = states_of_rows(log)
    drawn = np.array([what not in NOT_DRAWN for what in STATES])[state]
    kept = drawn & _meets(log, from_s, to_s)[rows]
    rows, state = rows[kept], state[kept]
    order = np.lexsort([log["start_s"][rows], log["worker"][rows]])
    rows, state = rows[order], state[order]
    named = {name: log[name][rows] for name in ("worker", "station", "job", "product")}
    start_s, end_s = log["start_s"][rows], log["end_s"][rows]
    begins = np.flatnonzero(changes(state, *named.values()) | _gaps(start_s, end_s))
    columns = {"row": named["worker"][begins], "what": state[begins], "start_s": start_s[begins]}
    columns |= {"end_s": end_s[_lasts(begins, rows.size)]}
    columns |= {name: named[name][begins] for name in ("job", "product", "station")}
    return Stretches(STATES, columns)
