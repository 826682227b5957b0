"""What tools, repair teams, transporters and cards would have to do."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import inf

from opsim.plan.failures import CLOCK
from opsim.plan.loads.outages import down_per_up
from opsim.plan.loads.rates import Flow, Flows, flows_of
from opsim.plan.loads.stations import StationLoad, station_loads
from opsim.plan.loads.work import batch_size, task_s, visit_s
from opsim.plan.plan import Plan

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
    plan: Plan, flows: Flows | None = None, stations: Iterable[StationLoad] | None = None
) -> list[SharedLoad]:
    """Load of everything that stations share, at least: nothing waits for anything else."""
    flows = flows_of(plan) if flows is None else flows
    loads = {load.station: load for load in (station_loads(plan, flows) if stations is None else stations)}
    return [*_tools(plan, flows), *_repair_teams(plan, loads, flows), *_transporters(plan, flows), *_cards(plan, flows)]


def _n(flow: Flow, flows: Flows) -> float:
    return flow.per_job if flows.saturated else flow.per_h


def _load(name: str, what: str, n: int, wanted: float, flows: Flows) -> SharedLoad:
    return SharedLoad(name, what, n, wanted, None if flows.saturated else wanted / n)


def _tools(plan: Plan, flows: Flows) -> Iterator[SharedLoad]:
    """Tools of a station are held for a visit at least, those of a task for the task."""
    wanted: defaultdict[int, float] = defaultdict(float)
    for flow in flows.steps:
        n = _n(flow, flows) / 3600 / batch_size(plan, flow.station)
        for tool, pieces in plan.stations[flow.station].needs:
            wanted[tool] += n * pieces * visit_s(plan, flow.station, flow.product)
        for task in plan.stations[flow.station].tasks:
            for tool, pieces in plan.tasks[task].needs:
                wanted[tool] += n * pieces * task_s(plan, task, flow.product)
    for rank, kind in enumerate(plan.tools):
        yield _load(kind.name, "tool", kind.n, wanted[rank], flows)


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
        yield _load(vehicle.name, "transporter", vehicle.n, seconds / 3600, flows)


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


def _cards(plan: Plan, flows: Flows) -> Iterator[SharedLoad]:
    """A card is out at least as long as the work between its two points takes (Little's law)."""
    for card in plan.cards:
        seconds = 0.0
        for flow in flows.steps:
            if flow.station in _held_at(plan, card.steps[flow.product], set(card.back), flow.product):
                seconds += _n(flow, flows) * visit_s(plan, flow.station, flow.product)
        if seconds < inf:
            yield _load(card.name, "cards", card.n, seconds / 3600, flows)


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
