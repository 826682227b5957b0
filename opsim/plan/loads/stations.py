"""What each station would have to do if nothing ever waited."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from math import inf

from opsim.plan.hours import Hours
from opsim.plan.loads.outages import up_share
from opsim.plan.loads.rates import Flow, Flows, flows_of
from opsim.plan.loads.work import batch_size, setup_s, task_s, tasks_at, visit_s
from opsim.plan.plan import Plan
from opsim.plan.station import CONVEYOR, STORE


@dataclass(frozen=True, slots=True)
class StationLoad:
    """work_s : mean work a visit at rating 1, a batch shared by its jobs; visits : for each job released (stations of
    one step share evenly); arrivals_per_h : None where the floor decides; setup_s : mean set-up a visit; up : share of
    its hours that it can work, stops taken out; hours : share of the run in which it is open, and its people are at
    work; most_per_h : visits that it can do on the mean of the run; load : share of that wanted, None as above;
    with_overtime : the load if people stayed for all the overtime that they may; None where that changes nothing.
    """

    station: str
    servers: int
    work_s: float
    visits: float
    arrivals_per_h: float | None
    load: float | None
    most_per_h: float
    setup_s: float = 0.0
    up: float = 1.0
    hours: float = 1.0
    with_overtime: float | None = None


def station_loads(plan: Plan, flows: Flows | None = None, hours: Hours | None = None) -> list[StationLoad]:
    """Load of each station and conveyor in natural order; a load above 1 cannot be worked off."""
    flows, hours = flows_of(plan) if flows is None else flows, Hours(plan) if hours is None else hours
    by_station: defaultdict[int, list[Flow]] = defaultdict(list)
    for flow in flows.steps:
        by_station[flow.station].append(flow)
    ranks = [rank for rank, station in enumerate(plan.stations) if station.kind != STORE]
    return [_load(plan, rank, by_station[rank], flows, hours) for rank in ranks]


def _load(plan: Plan, rank: int, here: list[Flow], flows: Flows, hours: Hours) -> StationLoad:
    station = plan.stations[rank]
    per_h, per_job = sum(flow.per_h for flow in here), sum(flow.per_job for flow in here)
    visits = per_job if flows.saturated else per_h / flows.per_h if flows.per_h else 0.0
    known = None if per_job > 0 or (flows.saturated and not per_h) else per_h
    work_s, change_s = _work_s(plan, rank, here), setup_s(plan, rank, here)
    up = up_share(plan, rank, work_s + change_s)
    on_server_s, parts = work_s + change_s, hand_and_alone_s(plan, rank, here)
    share = hours.working_share(rank, *parts)
    more = share if hours.with_overtime is hours.at_work else hours.working_share(rank, *parts, overtime=True)
    most = max(1, station.servers) * 3600 * up * share / on_server_s if on_server_s > 0 else inf
    most = min([most, *(3600 * up * share / line.takt_s for line in plan.lines if rank in line.stations)])
    load = None if known is None else known / most if most > 0 else inf
    late = load * share / more if load is not None and more > share > 0 else None
    return StationLoad(station.name, station.servers, work_s, visits, known, load, most, change_s, up, share, late)


def hand_and_alone_s(plan: Plan, station: int, here: list[Flow]) -> tuple[float, float]:
    """Seconds of a mean visit in which people are needed, and of what a station does without them."""
    total, hand_s, alone_s = sum(flow.per_h or flow.per_job for flow in here), 0.0, 0.0
    for flow in here if total else ():
        for task, part in tasks_at(plan, station):
            seconds = (flow.per_h or flow.per_job) / total * part * task_s(plan, task, flow.product)
            if plan.tasks[task].automatic:
                alone_s += seconds
            else:
                hand_s += seconds
    return hand_s, alone_s


def _work_s(plan: Plan, rank: int, here: list[Flow]) -> float:
    """Mean work of a visit, by what comes; of all products alike where nothing comes."""
    if plan.stations[rank].kind == CONVEYOR:
        return next(belt.headway_s for belt in plan.conveyors if belt.station == rank)
    weights = [flow.per_h or flow.per_job for flow in here]
    if sum(weights) <= 0:
        return sum(plan.tasks[task].mean_s() for task in plan.stations[rank].tasks)
    times = [visit_s(plan, rank, flow.product) for flow in here]
    mean_s = times[0] if len(set(times)) == 1 else sum(w * t for w, t in zip(weights, times)) / sum(weights)
    return mean_s / batch_size(plan, rank)
