"""When stations were down: how much of the time, how often, and how long until they ran again.

Which breakdown and which maintenance costs a station most, and how busy the repair teams are.

Laws: a station is down for one reason at a time and does nothing meanwhile; no team is at more stops than it can be.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.clock import ticks
from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, inside_s, mean, window_length_s
from opsim.laws.jobs import Stays, peak, words
from opsim.log import BREAKDOWN, DOWN, MAINTENANCE, REPAIR, SETUP, WORK, EventLog
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
            yield figure("stops_per_h", place.name, part, n / (window_length_s(plan) / SECONDS_PER_HOUR))
            yield figure("down_s", place.name, part, mean((ends - begins)[ended]))
            yield figure("wait_for_repair_s", place.name, part, mean(stop.waited_s[ended]))
            if part == "breakdown":
                up_s = window_length_s(plan) - inside_s(log, rows[station == rank], plan).sum()
                yield figure("mean_time_between_failures_s", place.name, "", up_s / n if n else np.nan)


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


def stops(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """stop_share: of each station and each of its stops by name, the share of the window in which it stood for it.

    repair_team_use: of each repair team, the share of its time at stations; 1: at as many as it can see to at once.
    """
    rows = outage_rows(log)
    seconds = inside_s(log, rows, plan)
    stood_s = np.bincount(log["task"][rows], weights=seconds, minlength=len(plan.tasks))
    at_work = log["kind"][rows] == REPAIR
    repaired_s = np.bincount(log["task"][rows][at_work], weights=seconds[at_work], minlength=len(plan.tasks))
    for stop in plan.stops:
        station = plan.stations[stop.station].name
        part = stop.name.removeprefix(f"{station}: ")
        yield figure("stop_share", station, part, stood_s[stop.task] / window_length_s(plan))
    for rank, team in enumerate(plan.repair_teams):
        spent_s = sum(repaired_s[stop.task] for stop in plan.stops if stop.team == rank)
        yield figure("repair_team_use", team.name, "", spent_s / (team.n * window_length_s(plan)))


def one_outage_at_a_time(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """Rows of a station's outages do not overlap, and no performance or set-up there overlaps with one of them."""
    down = log.where(np.isin(log["kind"], (DOWN, REPAIR)) & (log["job"] < 0) & (log["worker"] < 0))
    if not len(down):
        return
    at_work = log.where(np.isin(log["kind"], (WORK, SETUP)) & (log["station"] >= 0))
    for rank in np.unique(down["station"]):
        name = plan.stations[rank].name
        start, end = _sorted(down.where(down["station"] == rank))
        twice = np.flatnonzero(start[1:] < end[:-1])
        if twice.size:
            yield f"station {name}: goes down at {words(start[twice[0] + 1])}, while it is down already"
        begins, ends = _sorted(at_work.where(at_work["station"] == rank))
        before = np.searchsorted(start, ends, side="left") - 1  # the last outage that began before the work ended
        meets = np.flatnonzero((before >= 0) & (end[before] > begins))
        if meets.size:
            outage = before[meets[0]]
            yield f"station {name}: work goes on at {words(max(start[outage], begins[meets[0]]))}, while it is down"


def _sorted(rows: EventLog) -> tuple[np.ndarray, np.ndarray]:
    """(rows,) starts and ends in ticks, by start."""
    order = np.argsort(rows["start_s"], kind="stable")
    return ticks(rows["start_s"][order]), ticks(rows["end_s"][order])


def repair_teams_in_use(log: EventLog, plan: Plan) -> Iterator[str]:
    if not plan.repair_teams:
        return
    repairs = log.of(REPAIR)
    for rank, team in enumerate(plan.repair_teams):
        tasks = [stop.task for stops in (plan.breakdowns, plan.maintenance) for stop in stops if stop.team == rank]
        found = peak(repairs.where(np.isin(repairs["task"], tasks)))
        if found > team.n:
            yield f"repair team {team.name}: at {found} stops at once, and can see to {team.n}"
