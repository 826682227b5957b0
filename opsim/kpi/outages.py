"""When stations were down: how much of the time, how often, and how long until they ran again."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import SECONDS_PER_HOUR, inside_s, mean, window_length_s
from opsim.log import BREAKDOWN, DOWN, MAINTENANCE, REPAIR, EventLog
from opsim.plan import Plan

KINDS_OF_STOP = {"breakdown": BREAKDOWN, "maintenance": MAINTENANCE}


@dataclass(frozen=True, slots=True)
class Stretches:
    """Stretches of outages of one station by time, which do not overlap; every array is (N,)."""

    start_s: np.ndarray
    end_s: np.ndarray

    def meet_s(self, from_s: np.ndarray, to_s: np.ndarray) -> np.ndarray:
        """(rows,) seconds between two times in which the station was down."""
        if not self.start_s.size:
            return np.zeros(np.shape(from_s))
        return self._down_until(to_s) - self._down_until(from_s)

    def _down_until(self, at_s: np.ndarray) -> np.ndarray:
        edges_s = np.column_stack([self.start_s, self.end_s]).ravel()
        lengths_s = np.column_stack([np.zeros(self.start_s.size), self.end_s - self.start_s]).ravel()
        return np.interp(at_s, edges_s, np.cumsum(lengths_s))


def outage_rows(log: EventLog) -> np.ndarray:
    """Numbers of the rows in which a station was down or repaired, in time."""
    of_stations = np.isin(log["kind"], (DOWN, REPAIR)) & (log["worker"] < 0) & (log["job"] < 0) & (log["station"] >= 0)
    return np.flatnonzero(of_stations)


def outages_of(log: EventLog, rows: np.ndarray, station: int) -> Stretches:
    """The outages of one station among some rows."""
    here = rows[log["station"][rows] == station]
    here = here[np.argsort(log["start_s"][here], kind="stable")]
    return Stretches(log["start_s"][here], log["end_s"][here])


def outages(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each station that can stop, and of each kind of stop it has:

    stops_per_h : how often one began, an hour of the window
    down_s      : mean time from the stop until the station ran again, of those that ended in the window
    wait_for_repair_s : mean part of it in which nobody was there to repair
    mean_time_between_failures_s : time in which the station was not down, for each breakdown that began in the window
    """
    rows = outage_rows(log)
    cause, station = log["cause"][rows], log["station"][rows]
    low, high = plan.window_s
    for rank, place in enumerate(plan.stations):
        for part in stops_of(plan, rank):
            here = rows[(station == rank) & (cause == KINDS_OF_STOP[part])]
            stop = _stops(log, here)
            begins = log["start_s"][here][stop.first]
            n = int(((begins >= low) & (begins < high)).sum())
            ends = log["end_s"][here][stop.last]
            ended = (ends >= low) & (ends < high)
            yield Figure("stops_per_h", place.name, part, "1/h", n / (window_length_s(plan) / SECONDS_PER_HOUR))
            yield Figure("down_s", place.name, part, "s", mean((ends - begins)[ended]))
            yield Figure("wait_for_repair_s", place.name, part, "s", mean(stop.waited_s[ended]))
            if part == "breakdown":
                up_s = window_length_s(plan) - inside_s(log, rows[station == rank], plan).sum()
                yield Figure("mean_time_between_failures_s", place.name, "", "s", up_s / n if n else np.nan)


@dataclass(frozen=True, slots=True)
class _Stops:
    """first, last : numbers of the first and the last row of each stop; waited_s : of it, waiting for the team."""

    first: np.ndarray
    last: np.ndarray
    waited_s: np.ndarray


def _stops(log: EventLog, rows: np.ndarray) -> _Stops:
    """Rows of one station and cause, put together by stop: its task and the number of times that had happened."""
    if not rows.size:
        none = np.array([], dtype=int)
        return _Stops(none, none, np.array([]))
    changed = np.zeros(rows.size, dtype=bool)
    for column in ("task", "k"):
        changed[1:] |= log[column][rows][1:] != log[column][rows][:-1]
    changed[0] = True
    first = np.flatnonzero(changed)
    waited_s = np.where(log["kind"][rows] == DOWN, log.duration_s[rows], 0.0)
    return _Stops(first, np.r_[first[1:], rows.size] - 1, np.add.reduceat(waited_s, first))


def stops_of(plan: Plan, station: int) -> list[str]:
    """The kinds of stops a station has: ``breakdown``, ``maintenance``."""
    by_kind: dict[str, tuple] = {"breakdown": plan.breakdowns, "maintenance": plan.maintenance}
    return [kind for kind, stops in by_kind.items() if any(stop.station == station for stop in stops)]
