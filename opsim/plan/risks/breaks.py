"""Breaks that stop the bottleneck: all of its people at once, or all of those who feed it for longer than its buffer
lasts."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.plan.hours import Hours
from opsim.plan.hours.people import runs_on_s
from opsim.plan.hours.spans import Spans, both, together, total_s, without
from opsim.plan.loads.bottleneck import Loads
from opsim.plan.loads.stations import StationLoad, hand_and_alone_s
from opsim.plan.plan import Plan
from opsim.plan.risks.words import lasting, worker_names

BUSY = 0.8
"""Share of the time of a station from which on a stop of it is output that is lost."""
WORTH = 0.01
"""Share of its hours from which on it is worth a word that it stands."""


def starving_breaks(plan: Plan, hours: Hours, loads: Loads, by_hand: set[int]) -> Iterator[str]:
    """What breaks cost at the station that limits the floor; nothing where it has time to spare."""
    found = _bottleneck(plan, loads)
    if found is None:
        return
    rank, load = found
    if any(rank in line.stations for line in plan.lines):
        return  # a line stands while all its people have a break, and nothing runs dry
    pauses = _pauses(plan, hours, rank) if rank in by_hand else ()
    yield from _all_at_once(plan, hours, loads, rank, pauses)
    for before in sorted(_before(plan, rank) & by_hand):
        yield from _starved(plan, hours, rank, load, before, pauses)


def _all_at_once(plan: Plan, hours: Hours, loads: Loads, rank: int, pauses: Spans) -> Iterator[str]:
    """Breaks of all who can work at the bottleneck; what it does by itself goes on meanwhile."""
    hand_s, alone_s = hand_and_alone_s(plan, rank, [flow for flow in loads.flows.steps if flow.station == rank])
    if hand_s <= 0:
        return
    on_s = alone_s / (hand_s + alone_s) * sum(runs_on_s(end_s - start_s, alone_s) for start_s, end_s in pauses)
    lost_s = total_s(pauses) - on_s
    if lost_s <= WORTH * total_s(hours.manned(rank)):
        return
    who, at_once = _pausing(hours, rank, pauses)
    remedy = "let them have breaks one after the other, or " if at_once > hours.team(rank) else ""
    yield (
        f"{_said(plan, hours, rank, who, at_once)}: it stands for {lasting(lost_s)} of the run; {remedy}give the skill "
        "to somebody else who is there then"
    )


def _pausing(hours: Hours, station: int, pauses: Spans) -> tuple[list[int], int]:
    """Who of those who can work at a station is on shift in some pauses, and how many at once, at most."""
    there = {worker: both(pauses, hours.on_duty[worker]) for worker in sorted(hours.able(station))}
    who = [worker for worker, spans in there.items() if spans]
    return who, max((len(here) for _, _, here in together([there[worker] for worker in who])), default=0)


def _few(plan: Plan, who: list[int]) -> list[str]:
    names = [plan.workers[worker].name for worker in who]
    return names if len(names) <= 3 else [*names[:2], f"{len(names) - 2} more"]


def _said(plan: Plan, hours: Hours, station: int, who: list[int], at_once: int) -> str:
    """Whose breaks stop the bottleneck."""
    name, names, team = plan.stations[station].name, worker_names(plan, who), hours.team(station)
    if team > 1:
        return f"breaks leave fewer than the {team} people that {name}, the bottleneck, takes ({names})"
    if at_once == 1:
        return f"nobody works at {name}, the bottleneck, in the breaks of {' and of '.join(_few(plan, who))}"
    return f"all who are there and can work at {name}, the bottleneck, have their breaks at once ({names})"


def _bottleneck(plan: Plan, loads: Loads) -> tuple[int, StationLoad] | None:
    """(rank, load) of the station that limits the floor most, if it has no time to spare."""
    ranks = {station.name: rank for rank, station in enumerate(plan.stations)}
    by_name = {load.station: load for load in loads.stations}
    for limit in loads.limits:
        if limit.what in by_name:
            load = by_name[limit.what]
            return None if load.load is not None and load.load < BUSY else (ranks[limit.what], load)
    return None


def _pauses(plan: Plan, hours: Hours, station: int) -> Spans:
    """When a station is open and its people are on shift, and too few of them at work."""
    there = both(hours.open(station), hours.manned(station))
    return without(there, hours.manned(station, at_work=True))


def _before(plan: Plan, station: int) -> set[int]:
    """The stations from which jobs come to a station."""
    found: set[int] = set()
    for product in plan.products:
        for step, ways in zip(product.route, product.onward):
            if any(other >= 0 and station in product.route[other].stations for _, other in ways):
                found.update(step.stations)
    return found - {station}


def _starved(plan: Plan, hours: Hours, rank: int, load: StationLoad, before: int, pauses: Spans) -> Iterator[str]:
    """A station in front whose people all pause for longer than what waits at the bottleneck lasts."""
    n_waiting = plan.stations[rank].buffer + plan.stations[before].buffer_after
    each_s = (load.work_s + load.setup_s) / max(1, load.servers)
    stops = without(_pauses(plan, hours, before), pauses)
    longest_s = max((end_s - start_s for start_s, end_s in stops), default=0.0)
    if longest_s > n_waiting * each_s:
        several = _pausing(hours, before, stops)[1] > hours.team(before)
        remedy = "let them have breaks one after the other, or give it" if several else "give it"
        yield (
            f"{load.station}, the bottleneck, runs dry in the breaks of {plan.stations[before].name}: all who can work "
            f"there pause for {lasting(longest_s)} at once, and the {n_waiting:.0f} jobs that can wait in between last "
            f"{lasting(n_waiting * each_s)}; {remedy} a larger buffer"
        )
