"""Breaks that stop the bottleneck: all of its people at once, or all of those who feed it for longer than its buffer
lasts."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.plan.hours import Hours
from opsim.plan.hours.spans import Spans, both, total_s, without
from opsim.plan.loads.bottleneck import Loads
from opsim.plan.loads.stations import StationLoad
from opsim.plan.plan import Plan
from opsim.plan.risks.words import lasting, worker_names

BUSY = 0.8
"""Share of the time of a station from which on a stop of it is output that is lost."""


def starving_breaks(plan: Plan, hours: Hours, loads: Loads, by_hand: set[int]) -> Iterator[str]:
    """What breaks cost at the station that limits the floor; nothing where it has time to spare."""
    found = _bottleneck(plan, loads)
    if found is None:
        return
    rank, load = found
    lost = _pauses(plan, hours, rank) if rank in by_hand else ()
    if lost:
        who, team = worker_names(plan, hours.able(rank)), hours.team(rank)
        together = (
            f"all who can work at {load.station}, the bottleneck, have their breaks at once ({who})"
            if team == 1
            else f"breaks leave fewer than the {team} people that {load.station}, the bottleneck, takes ({who})"
        )
        yield (
            f"{together}: it stands for {lasting(total_s(lost))} of the run; let them have breaks one after the other, "
            "or give somebody else the skill"
        )
    for before in sorted(_before(plan, rank) & by_hand):
        yield from _starved(plan, hours, rank, load, before, lost)


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


def _starved(plan: Plan, hours: Hours, rank: int, load: StationLoad, before: int, lost: Spans) -> Iterator[str]:
    """A station in front whose people all pause for longer than what waits at the bottleneck lasts."""
    n_waiting = plan.stations[rank].buffer + plan.stations[before].buffer_after
    each_s = (load.work_s + load.setup_s) / max(1, load.servers)
    stops = without(_pauses(plan, hours, before), lost)
    longest_s = max((end_s - start_s for start_s, end_s in stops), default=0.0)
    if longest_s > n_waiting * each_s:
        yield (
            f"{load.station}, the bottleneck, runs dry in the breaks of {plan.stations[before].name}: all who can work "
            f"there pause for {lasting(longest_s)} at once, and the {n_waiting:.0f} jobs that can wait in between last "
            f"{lasting(n_waiting * each_s)}; let them have breaks one after the other, or give it a larger buffer"
        )
