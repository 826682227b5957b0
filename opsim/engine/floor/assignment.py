"""Whose work it is: zones, floaters, priorities, the way ahead; and how long somebody on patrol stays."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.keys import put
from opsim.engine.floor.parts.state import Floor, Job, Station, Worker
from opsim.engine.rules import allocation
from opsim.plan.evenness import LEAST_EXPOSED
from opsim.plan.sequence import MOST_DOWNSTREAM

ORDER = 1
"""Among the ways to begin a task: somebody on patrol has come for one before anything else is looked at."""
_whose_it_is, _more_urgent = inlined(allocation.whose_it_is), inlined(allocation.more_urgent)
_nearer_to_its_end = inlined(allocation.nearer_to_its_end)


def install(build: Any) -> None:
    """What comes before the rule of allocation, where there is some; one operation a stop, where the plan says so."""
    for part in _parts(build.plan):
        build.hang(build.floor.prefixes, part)
    if build.plan.idle == "patrol" and build.plan.serve == "one":
        for station in build.stations:
            build.hang(station.acts, serves, None, ORDER)


def _parts(plan: Any) -> Any:
    if any(worker.zone or worker.floater for worker in plan.workers):
        yield by_zone
    by = {"stations": by_station, "products": by_product}
    wanted = {"stations": any(station.priority for station in plan.stations), "products": True}
    yield from (by[name] for name in plan.priorities if wanted[name])
    if plan.rule == MOST_DOWNSTREAM:
        yield by_way_ahead
    if plan.rule == LEAST_EXPOSED:
        from opsim.engine.floor.doses import by_dose

        yield by_dose


@step
def by_zone(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """People whose own station it is come first, then floaters."""
    outside = 1 if worker.has_zone and not worker.zone[station.rank] else 0
    key = _whose_it_is(outside, worker.floater)
    put(floor, float(key[0]))
    put(floor, float(key[1]))
    return True


@step
def by_station(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """The station of the higher priority."""
    put(floor, _more_urgent(station.priority)[0])
    return True


@step
def by_product(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """The job of the higher priority."""
    put(floor, _more_urgent(job.priority)[0])
    return True


@step
def by_way_ahead(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """The job with the fewest operations left, on average."""
    put(floor, _nearer_to_its_end(job.plan.left_steps[job.step])[0])
    return True


@step
def serves(floor: Floor, subject: Any, job: Job, worker: Worker) -> bool:
    """He has come to work at this stop of his round: he does one operation, and walks on."""
    worker.served = 1
    return False
