"""Whose work it is: zones, floaters, priorities, the way ahead; and how long somebody on patrol stays."""

from collections.abc import Callable

from opsim.engine.rules.allocation import less_gone_through, more_urgent, nearer_to_its_end, whose_it_is
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.plan import Plan
from opsim.plan.evenness import LEAST_EXPOSED
from opsim.plan.sequence import MOST_DOWNSTREAM

ORDER = 1
"""Among the ways to begin a task: somebody on patrol has come for one before anything else is looked at."""

Part = Callable[[Worker, Station, Job], tuple[float, ...]]


def install(floor: Floor) -> None:
    """What comes before the rule of allocation, where the plan has some of it; one operation a stop, where it says so.

    Nothing is hung on the floor where neither is so.
    """
    parts = (*_parts(floor.plan), *_doses(floor))
    if parts:
        floor.prefix = parts[0] if len(parts) == 1 else lambda *pair: sum((part(*pair) for part in parts), ())
    if floor.plan.idle == "patrol" and floor.plan.serve == "one":
        for station in floor.stations:
            station.add_act(ORDER, _serves)


def _parts(plan: Plan):
    if any(worker.zone or worker.floater for worker in plan.workers):
        yield _by_zone
    by = {"stations": _by_station, "products": _by_product}
    wanted = {"stations": any(station.priority for station in plan.stations), "products": True}
    yield from (by[name] for name in plan.priorities if wanted[name])
    if plan.rule == MOST_DOWNSTREAM:
        to_go = plan.ahead.left_steps if plan.ahead is not None else ()
        yield lambda _worker, _station, job: nearer_to_its_end(to_go[job.product][job.step])


def _doses(floor: Floor):
    if floor.plan.rule == LEAST_EXPOSED:
        yield lambda worker, _station, _job: less_gone_through(floor.doses[worker.rank].so_far(floor.now))


def _by_zone(worker: Worker, station: Station, _job: Job) -> tuple[float, ...]:
    zone = worker.plan.zone
    return whose_it_is(bool(zone) and station.rank not in zone, worker.plan.floater)


def _by_station(_worker: Worker, station: Station, _job: Job) -> tuple[float, ...]:
    return more_urgent(station.plan.priority)


def _by_product(_worker: Worker, _station: Station, job: Job) -> tuple[float, ...]:
    return more_urgent(job.priority)


def _serves(_floor: Floor, _job: Job, worker: Worker) -> bool:
    """He has come to work at this stop of his round: he does one operation, and walks on."""
    worker.served = True
    return False
