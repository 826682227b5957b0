"""Work for which nobody is there: on some shift, at no time, or because people and stations never meet."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.names import enumerated, natural_key
from opsim.plan.hours import Hours
from opsim.plan.hours.spans import Spans, at_least, both, total_s, without
from opsim.plan.plan import Plan
from opsim.plan.risks.words import SHORT_S, lasting, on_shifts


def unmanned(plan: Plan, hours: Hours, by_hand: set[int]) -> Iterator[str]:
    """Stations that nobody on some shift can work at, or nobody ever; people and sources whose hours never come.

    by_hand : ranks of the stations where people have something to do.
    """
    yield from _never_there(plan)
    for station in sorted(by_hand):
        if hours.able(station):
            yield from _station(plan, hours, station)
    yield from _sources(plan, hours, by_hand)


def _never_there(plan: Plan) -> Iterator[str]:
    names = [worker.name for worker in plan.workers if worker.duties is not None and not worker.duties]
    if names:
        who = f"{enumerated(names)} {'is' if len(names) == 1 else 'are'}"
        yield f"{who} never on shift in this run of {lasting(plan.horizon_s)}"


def _station(plan: Plan, hours: Hours, station: int) -> Iterator[str]:
    name, is_open, there = plan.stations[station].name, hours.open(station), hours.manned(station)
    team = hours.team(station)
    if not is_open:
        yield f"{name} is never open in this run of {lasting(plan.horizon_s)}"
    elif not there:
        who = "nobody who can work" if team == 1 else f"never {team} people at once who can work"
        yield f"{who} at {name} {'is ever' if team == 1 else 'are'} on shift: nothing will happen there"
    elif not both(is_open, there):
        who = "nobody is" if team == 1 else f"fewer than {team} people are"
        yield f"{name} is open only when {who} on shift who can work there: nothing will happen there"
    else:
        yield from _sometimes(plan, hours, station, without(both(is_open, hours.somebody), there))


def _sometimes(plan: Plan, hours: Hours, station: int, missing: Spans) -> Iterator[str]:
    """Times at which others work and a station stands for want of its people."""
    if total_s(missing) >= SHORT_S:
        few = "nobody" if hours.team(station) == 1 else "too few people"
        yield (
            f"{few}{on_shifts(plan, hours, missing)} can work at {plan.stations[station].name}: it stands for "
            f"{lasting(total_s(missing))} of the run in which others work "
            f"({total_s(missing) / total_s(hours.open(station)):.0%} of the time that it is open)"
        )


def _sources(plan: Plan, hours: Hours, by_hand: set[int]) -> Iterator[str]:
    """Sources that make jobs only when everybody who would work on them is away."""
    for source in sorted(plan.sources, key=lambda source: natural_key(source.name)):
        made = [plan.products[product] for product, _ in source.mix]
        wanted = {rank for product in made for step in product.route for rank in step.stations} & by_hand
        there = at_least(1, [hours.manned(station) for station in wanted])
        if source.open_s is not None and wanted and there and not both(source.open_s, there):
            yield f"{source.name} lets jobs in only when nobody is there who works on them"
