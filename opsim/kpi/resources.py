"""How much tools are used, and how many jobs wait for them.

What transporters do, how far they drive, and how long jobs wait for them.

What lies in stores and on conveyors.

When stations were down: how much of the time, how often, and how long until they ran again.

Which breakdown and which maintenance costs a station most, and how busy the repair teams are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, by_rank, created_s, in_window, inside_s, mean, window_length_s
from opsim.log import (
    BLOCKED,
    BREAKDOWN,
    DOWN,
    HELD,
    IDLE,
    JOB_KINDS,
    JOIN,
    MAINTENANCE,
    NO_TOOL,
    PICKUP,
    QUEUE,
    REPAIR,
    STOCK,
    TOOL,
    TRANSPORT,
    EventLog,
)
from opsim.plan import Plan
from opsim.plan.compile import stores_of
from opsim.plan.stations import CONVEYOR, STORE


def tools(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each tool, over the window: tool_use, the share of all of them that jobs have, in use or kept for it; and of
    all together tools_waited_for, the jobs that wait for one or several, on average.
    """
    if not plan.tools:
        return
    rows, length_s = np.flatnonzero(log["kind"] == TOOL), window_length_s(plan)
    spent_s = np.bincount(log["k"][rows], weights=inside_s(log, rows, plan), minlength=len(plan.tools))
    for tool, had_s in zip(plan.tools, spent_s):
        yield figure("tool_use", tool.name, "", had_s / (tool.n * length_s))
    waiting = np.flatnonzero((log["kind"] == HELD) & (log["cause"] == NO_TOOL))
    yield figure("tools_waited_for", "", "", inside_s(log, waiting, plan).sum() / length_s)


def transporters(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each transporter, over the window and all its vehicles:

    transporter_states : shares of time that sum to 1: loaded (driving with jobs), empty (driving without), handling
                         (loading or unloading), free
    driven_m           : metres of all its vehicles together, by the time that a drive has in the window
    pickup_wait_s      : from when a job could go until it was loaded, mean of those loaded in the window that waited
    """
    first, length_s = 0, window_length_s(plan)
    for pool in plan.transporters:
        rows = _rows(log, first, pool.n)
        first += pool.n
        spent_s, stands = inside_s(log, rows, plan), log["place_from"][rows] == log["place_to"][rows]
        empty = np.isin(log["cause"][rows], (PICKUP, IDLE))
        states = {
            "loaded": spent_s[~empty & ~stands].sum(),
            "empty": spent_s[empty].sum(),
            "handling": spent_s[~empty & stands].sum(),
        }
        states["free"] = pool.n * length_s - sum(states.values())
        for part, seconds in states.items():
            yield figure("transporter_states", pool.name, part, seconds / (pool.n * length_s))
        yield figure("driven_m", pool.name, "", spent_s[~stands].sum() * pool.speed_m_per_s)
        waits_s = _waits_s(log, plan, {(leg.before, leg.after) for leg in pool.legs})
        if waits_s.size:
            yield figure("pickup_wait_s", pool.name, "", mean(waits_s))


def _rows(log: EventLog, first: int, n: int) -> np.ndarray:
    """The rows of n vehicles, from the number of the first."""
    vehicles = (log["kind"] == TRANSPORT) & (log["job"] < 0)
    return np.flatnonzero(vehicles & (log["k"] >= first) & (log["k"] < first + n))


def _waits_s(log: EventLog, plan: Plan, legs: set[tuple[int, int]]) -> np.ndarray:
    """Seconds of each job that waited for a vehicle of some legs, and was loaded in the window."""
    loaded = np.flatnonzero((log["job"] >= 0) & (log["kind"] == TRANSPORT))
    goal = {(log["job"][row], log["start_s"][row]): log["station"][row] for row in loaded}
    asked = np.isin(log["kind"], (HELD, QUEUE)) & (log["cause"] == PICKUP) & in_window(log["end_s"], plan)
    waited = [row for row in np.flatnonzero(asked) if (log["job"][row], log["end_s"][row]) in goal]
    mine = [row for row in waited if (log["station"][row], goal[log["job"][row], log["end_s"][row]]) in legs]
    return log["end_s"][mine] - log["start_s"][mine]


def stores(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each store:

    stock       : jobs that lie there, averaged over the window; of each product where several end there
    stock_empty : share of the window in which there is none; of each product where several end there
    And parts_used_per_h of each product that others are made of, in units; what ``stored`` says of those that come.
    """
    for rank, store in enumerate(plan.stations):
        if store.kind != STORE:
            continue
        here = np.flatnonzero((log["station"] == rank) & (log["kind"] == QUEUE) & (log["cause"] == STOCK))
        yield from _stock(log, plan, here, store.name, "")
        ends = [product for product in range(len(plan.products)) if rank in stores_of(plan, product)]
        for product in ends if len(ends) > 1 else ():
            of_it = here[log["product"][here] == product]
            yield from _stock(log, plan, of_it, store.name, plan.products[product].name)
    yield from stored(log, plan)
    used = np.flatnonzero((log["kind"] == JOIN) & in_window(log["end_s"], plan))
    for product in sorted({part for kit in plan.kits for part, _ in kit.parts}):
        units = int((log["product"][used] == product).sum()) * plan.products[product].lot
        per_h = units / (window_length_s(plan) / SECONDS_PER_HOUR)
        yield figure("parts_used_per_h", plan.products[product].name, "", per_h)


def conveyors(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each conveyor: on_conveyor, jobs on it, averaged over the window; conveyor_blocked, the share of the window in
    which the job at its end finds no room.
    """
    for rank, belt in enumerate(plan.stations):
        if belt.kind != CONVEYOR:
            continue
        here = np.flatnonzero((log["station"] == rank) & (log["job"] >= 0) & np.isin(log["kind"], JOB_KINDS))
        blocked = here[log["kind"][here] == BLOCKED]
        length_s = window_length_s(plan)
        yield figure("on_conveyor", belt.name, "", inside_s(log, here, plan).sum() / length_s)
        yield figure("conveyor_blocked", belt.name, "", any_s(log, plan, blocked) / length_s)


def _stock(log: EventLog, plan: Plan, rows: np.ndarray, store: str, product: str) -> Iterator[Figure]:
    length_s = window_length_s(plan)
    yield figure("stock", store, product, inside_s(log, rows, plan).sum() / length_s)
    yield figure("stock_empty", store, product, 1.0 - any_s(log, plan, rows) / length_s)


def any_s(log: EventLog, plan: Plan, rows: np.ndarray) -> float:
    """Seconds of the window in which any of some rows is open."""
    order = rows[np.argsort(log["start_s"][rows], kind="stable")]
    start_s, end_s = (np.clip(log[edge][order], *plan.window_s) for edge in ("start_s", "end_s"))
    covered_s = np.maximum.accumulate(np.r_[plan.window_s[0], end_s])[:-1]
    return float(np.maximum(end_s - np.maximum(start_s, covered_s), 0.0).sum())


def stored(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each product that ends in a store: stored_per_h, units that came there in an hour of the window, and
    time_to_store_s, their mean time from creation. What is taken as it comes is counted too, initial stock is not.
    """
    lying = np.flatnonzero((log["kind"] == QUEUE) & (log["cause"] == STOCK))
    used = np.flatnonzero(log["kind"] == JOIN)
    used = used[~np.isin(log["job"][used], log["job"][lying])]
    rows = np.r_[lying, used]
    came_s = np.r_[log["start_s"][lying], log["end_s"][used]]
    took_s = came_s - created_s(log, log["job"][rows])
    counted = in_window(came_s, plan) & (took_s > 0)
    by_product = by_rank(took_s[counted], log["product"][rows][counted], len(plan.products))
    for rank, (product, times_s) in enumerate(zip(plan.products, by_product)):
        if stores_of(plan, rank):
            per_h = times_s.size * product.lot / (window_length_s(plan) / SECONDS_PER_HOUR)
            yield figure("stored_per_h", product.name, "", per_h)
            yield figure("time_to_store_s", product.name, "", mean(times_s))


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
