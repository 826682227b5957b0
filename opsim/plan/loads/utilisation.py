"""How much of its time a station is up when it always works: breakdowns and planned maintenance.

What each station would have to do if nothing ever waited.

What tools, repair teams, transporters and cards would have to do.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import inf

from opsim.plan.loads.flows import Flow, Flows, flows_of
from opsim.plan.loads.work_times import WorkTimes, batch_size
from opsim.plan.plan import Plan
from opsim.subjects.breakdowns.plan import BUSY, CLOCK, BreakdownPlan
from opsim.subjects.stations.plan import CONVEYOR, STORE


def down_per_up(plan: Plan, stop: BreakdownPlan, visit_s: float) -> float:
    """Seconds of repair for each second that the station is up and at work; waiting for a repair team not counted.

    visit_s : time of a visit on a server, for breakdowns that count cycles.
    """
    repair_s, every = plan.tasks[stop.task].mean_s(), stop.every.mean_duration_s()
    if stop.by in (CLOCK, BUSY):
        return repair_s / every
    servers = plan.stations[stop.station].servers
    return repair_s * servers / (every * visit_s) if visit_s > 0 else 0.0


def up_share(plan: Plan, station: int, visit_s: float) -> float:
    """Share of the time that a station can work, from 0 to 1."""
    down = sum(down_per_up(plan, stop, visit_s) for stop in plan.breakdowns if stop.station == station)
    planned = sum(plan.tasks[stop.task].mean_s() / stop.every_s for stop in plan.maintenance if stop.station == station)
    return max(0.0, 1.0 - planned) / (1.0 + down)


@dataclass(frozen=True, slots=True)
class StationLoad:
    """At least: everything is done by the fastest who can do it, so that no load is said to be above the true one.

    work_s : mean work a visit, a batch shared by its jobs; visits : for each job released (stations of
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


def station_loads(plan: Plan, flows: Flows | None = None, times: WorkTimes | None = None) -> list[StationLoad]:
    """Load of each station and conveyor in natural order; a load above 1 cannot be worked off."""
    flows, times = flows_of(plan) if flows is None else flows, WorkTimes(plan) if times is None else times
    by_station: defaultdict[int, list[Flow]] = defaultdict(list)
    for flow in flows.steps:
        by_station[flow.station].append(flow)
    ranks = [rank for rank, station in enumerate(plan.stations) if station.kind != STORE]
    return [_load(times, rank, by_station[rank], flows) for rank in ranks]


def _load(times: WorkTimes, rank: int, here: list[Flow], flows: Flows) -> StationLoad:
    plan, hours = times.plan, times.hours
    station = plan.stations[rank]
    per_h, per_job = sum(flow.per_h for flow in here), sum(flow.per_job for flow in here)
    visits = per_job if flows.saturated else per_h / flows.per_h if flows.per_h else 0.0
    known = None if per_job > 0 or (flows.saturated and not per_h) else per_h
    work_s, change_s = _work_s(times, rank, here), times.least_setup_s(rank, here)
    up = up_share(plan, rank, work_s + change_s)
    on_server_s, parts = work_s + change_s, hand_and_alone_s(times, rank, here)
    share = hours.working_share(rank, *parts)
    more = share if hours.with_overtime is hours.at_work else hours.working_share(rank, *parts, overtime=True)
    most = max(1, station.servers) * 3600 * up * share / on_server_s if on_server_s > 0 else inf
    most = min([most, *(3600 * up * share / line.takt_s for line in plan.lines if rank in line.stations)])
    load = None if known is None else known / most if most > 0 else inf
    late = load * share / more if load is not None and more > share > 0 else None
    return StationLoad(station.name, station.servers, work_s, visits, known, load, most, change_s, up, share, late)


def hand_and_alone_s(times: WorkTimes, station: int, here: list[Flow]) -> tuple[float, float]:
    """Seconds of a mean visit in which people are needed, and of what a station does without them."""
    total, hand_s, alone_s = sum(flow.per_h or flow.per_job for flow in here), 0.0, 0.0
    for flow in here if total else ():
        for task, n in times.tasks(station, flow.product):
            seconds = (flow.per_h or flow.per_job) / total * n * times.least_s(station, task)
            if task.automatic:
                alone_s += seconds
            else:
                hand_s += seconds
    return hand_s, alone_s


def _work_s(times: WorkTimes, rank: int, here: list[Flow]) -> float:
    """Mean work of a visit, by what comes; of all products alike where nothing comes."""
    plan = times.plan
    if plan.stations[rank].kind == CONVEYOR:
        return next(belt.headway_s for belt in plan.conveyors if belt.station == rank)
    weights = [flow.per_h or flow.per_job for flow in here]
    if sum(weights) <= 0:
        return sum(times.least_s(rank, plan.tasks[task]) for task in plan.stations[rank].tasks)
    seconds = [times.least_visit_s(rank, flow.product) for flow in here]
    mean_s = seconds[0] if len(set(seconds)) == 1 else sum(w * t for w, t in zip(weights, seconds)) / sum(weights)
    return mean_s / batch_size(plan, rank)


REPAIR_TEAM = "repair team"


@dataclass(frozen=True, slots=True)
class SharedLoad:
    """what : tool, repair team, transporter or cards; n : how many there are; wanted : how many are busy on average,
    for each job an hour where the floor decides what comes in; load : share of them, None as above.
    """

    name: str
    what: str
    n: int
    wanted: float
    load: float | None


def shared_loads(
    plan: Plan,
    flows: Flows | None = None,
    stations: Iterable[StationLoad] | None = None,
    times: WorkTimes | None = None,
) -> list[SharedLoad]:
    """Load of everything that stations share, at least: nothing waits, and the fastest do the work."""
    flows, times = flows_of(plan) if flows is None else flows, WorkTimes(plan) if times is None else times
    loads = {load.station: load for load in (station_loads(plan, flows, times) if stations is None else stations)}
    others = (*_repair_teams(plan, loads, flows), *_transporters(plan, flows))
    return [*_tools(times, flows), *others, *_cards(times, flows)]


def _n(flow: Flow, flows: Flows) -> float:
    return flow.per_job if flows.saturated else flow.per_h


def _shared_load(name: str, what: str, n: int, wanted: float, flows: Flows) -> SharedLoad:
    return SharedLoad(name, what, n, wanted, None if flows.saturated else wanted / n)


def _tools(times: WorkTimes, flows: Flows) -> Iterator[SharedLoad]:
    """Tools of a station are held for a visit at least, those of a task for the task."""
    plan = times.plan
    wanted: defaultdict[int, float] = defaultdict(float)
    for flow in flows.steps:
        n = _n(flow, flows) / 3600 / batch_size(plan, flow.station)
        for tool, pieces in plan.stations[flow.station].needs:
            wanted[tool] += n * pieces * times.least_visit_s(flow.station, flow.product)
        for task, times_done in times.tasks(flow.station, flow.product):
            for tool, pieces in task.needs:
                wanted[tool] += n * pieces * times_done * times.least_s(flow.station, task)
    for rank, kind in enumerate(plan.tools):
        yield _shared_load(kind.name, "tool", kind.n, wanted[rank], flows)


def _repair_teams(plan: Plan, loads: dict[str, StationLoad], flows: Flows) -> Iterator[SharedLoad]:
    """Stops by busy time or cycles come as often as the station works, at most always."""
    for rank, team in enumerate(plan.repair_teams):
        wanted = sum(plan.tasks[stop.task].mean_s() / stop.every_s for stop in plan.maintenance if stop.team == rank)
        for stop in plan.breakdowns:
            if stop.team == rank:
                load = loads[plan.stations[stop.station].name]
                at_work = load.hours if load.load is None else load.hours * min(1.0, load.load)
                busy = 1.0 if stop.by == CLOCK else at_work
                wanted += load.up * busy * down_per_up(plan, stop, load.work_s + load.setup_s)
        yield SharedLoad(team.name, REPAIR_TEAM, team.n, wanted, wanted / team.n)


def _transporters(plan: Plan, flows: Flows) -> Iterator[SharedLoad]:
    """Loading, driving with a full load and unloading; ways without a load do not count."""
    visits: defaultdict[tuple[int, int], float] = defaultdict(float)
    leaving: defaultdict[int, float] = defaultdict(float)
    for flow in flows.steps:
        leaving[flow.station] += _n(flow, flows)
    for before, after, share in _legs(plan):
        visits[before, after] += leaving[before] * share
    for vehicle in plan.transporters:
        seconds = sum(
            visits[leg.before, leg.after]
            * (vehicle.load_s + vehicle.unload_s + vehicle.drive_s(leg.place_from, leg.place_to) / vehicle.capacity)
            for leg in vehicle.legs
        )
        yield _shared_load(vehicle.name, "transporter", vehicle.n, seconds / 3600, flows)


def _legs(plan: Plan) -> Iterator[tuple[int, int, float]]:
    """(from, to, share of the jobs that leave) of each pair of points that follow each other; steps weigh alike."""
    onward: defaultdict[int, defaultdict[int, float]] = defaultdict(lambda: defaultdict(float))
    for made in plan.products:
        for step, ways in zip(made.route, made.onward):
            before = 0.0
            for cumulative, other in ways:
                there = made.route[other].stations if other >= 0 else (-1,)
                for station in step.stations:
                    for after in there:
                        onward[station][after] += made.share * (cumulative - before) / len(there)
                before = cumulative
    for station, shares in onward.items():
        total = sum(shares.values())
        yield from ((station, after, share / total) for after, share in shares.items() if after >= 0 and total > 0)


def _cards(times: WorkTimes, flows: Flows) -> Iterator[SharedLoad]:
    """A card is out at least as long as the work between its two points takes (Little's law)."""
    plan = times.plan
    for card in plan.cards:
        seconds = 0.0
        for flow in flows.steps:
            if flow.station in _held_at(plan, card.steps[flow.product], set(card.back), flow.product):
                seconds += _n(flow, flows) * times.least_visit_s(flow.station, flow.product)
        if seconds < inf:
            yield _shared_load(card.name, "cards", card.n, seconds / 3600, flows)


def _held_at(plan: Plan, steps: tuple[int, ...], back: set[int], product: int) -> set[int]:
    """The stations at which jobs of a product hold a card: from where it is taken to where it is given back."""
    made, todo, seen = plan.products[product], list(steps), set(steps)
    while todo:
        step = todo.pop()
        if not back.intersection(made.route[step].stations):
            onward = {other for _, other in made.onward[step] if other >= 0} - seen
            seen |= onward
            todo += onward
    return {station for step in seen for station in made.route[step].stations}
