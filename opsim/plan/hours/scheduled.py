"""Scheduled hours: when the floor as a whole is meant to work."""

from __future__ import annotations

from opsim.plan.hours.people import Hours
from opsim.plan.hours.spans import Spans, both, either
from opsim.plan.plan import Plan


def has_hours(plan: Plan) -> bool:
    """Whether anything or anybody of a plan keeps hours."""
    return floor_has_hours(plan) or any(source.open_s is not None for source in plan.sources)


def floor_has_hours(plan: Plan) -> bool:
    """Whether a station or somebody keeps hours."""
    stations = any(station.open_s is not None for station in plan.stations)
    return stations or any(worker.duties is not None for worker in plan.workers)


def scheduled(plan: Plan, hours: Hours | None = None) -> Spans:
    """When the floor is scheduled to be open, from 0 to the horizon: while at least one station on a route may work.

    A station may work while it is open (always, where it has no hours) and, where its tasks need people, while as many
    as its largest task takes of those who may be sent there are on shift: by plan, so breaks count, and absence and
    overtime change nothing; members of a crew count at its stations alone. A machine that works alone needs nobody.
    Sources do not count: what came in their hours is worked off in those of the stations. Where no station and nobody
    keeps hours it is all the time.
    """
    hours = Hours(plan) if hours is None else hours
    if not floor_has_hours(plan):
        return hours.always
    alike = {(plan.stations[rank].open_s, _people(hours, rank)): rank for rank in _on_routes(plan)}
    return either(*(_may_work(hours, rank) for rank in alike.values()))


def _may_work(hours: Hours, station: int) -> Spans:
    """When a station is open, and has the people it needs."""
    needs, is_open = _people(hours, station) is not None, hours.open(station)
    return both(is_open, hours.manned(station)) if needs else is_open


def _people(hours: Hours, station: int) -> tuple[int, frozenset[int]] | None:
    """How many people a station takes at most, and who they may be; None where it needs nobody."""
    alone = all(hours.plan.tasks[task].automatic for task in hours.plan.stations[station].tasks)
    return None if alone else (hours.team(station), hours.able(station))


def _on_routes(plan: Plan) -> list[int]:
    """Ranks of the stations where jobs are worked on; stores and conveyors have no tasks."""
    found = {rank for product in plan.products for operation in product.route for rank in operation.stations}
    return sorted(rank for rank in found if plan.stations[rank].tasks)
