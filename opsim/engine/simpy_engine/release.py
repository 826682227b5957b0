"""Sources: the processes of those that do not wait for room."""

from collections.abc import Generator
from math import inf

import simpy

from opsim.clock import on_grid
from opsim.engine.rules import ARRIVAL
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.material import create, new_job, want_in
from opsim.engine.simpy_engine.state import Source
from opsim.plan.calendar import OPEN
from opsim.plan.orders import OrderPlan
from opsim.plan.release import POISSON, RENEWAL, SCHEDULE

ARRIVED, ORDERED = "job arrived", "order arrived"
Process = Generator[simpy.Event, None, None]


def install(floor: Floor) -> None:
    """A process for each source of a time of its own."""
    for source in floor.sources:
        if source.plan.kind in (POISSON, RENEWAL):
            open_s = source.plan.open_s
            timed = release_by_time(floor, source) if open_s is None else release_in_hours(floor, source, open_s)
            floor.env.process(timed)
        elif source.plan.kind == SCHEDULE:
            floor.env.process(release_by_order(floor, source))


def release_by_time(floor: Floor, source: Source) -> Process:
    """The SimPy process of a source of its own time: wait a gap, report an arrival."""
    for number, gap_s in enumerate(floor.draws.gaps(source.rank)):
        yield floor.env.timeout(on_grid(gap_s))
        floor.report(ARRIVAL, source.rank, number, ARRIVED, source)


def release_in_hours(floor: Floor, source: Source, open_s: OPEN) -> Process:
    """As ``release_by_time``, where gaps count open time alone. What comes as the hours end comes with the next."""
    env, hours = floor.env, iter(open_s)
    at_s = until_s = 0.0
    for number, gap_s in enumerate(floor.draws.gaps(source.rank)):
        left_s = on_grid(gap_s)
        while left_s >= until_s - at_s:
            left_s -= until_s - at_s
            at_s, until_s = next(hours, (inf, inf))
            if at_s == inf:
                return
        at_s += left_s
        yield env.timeout(at_s - env.now)
        floor.report(ARRIVAL, source.rank, number, ARRIVED, source)


def release_by_order(floor: Floor, source: Source) -> Process:
    """The SimPy process of a schedule: wait for the time of the next order, report it."""
    env = floor.env
    for number, order in enumerate(source.plan.orders):
        if order.time_s > env.now:
            yield env.timeout(order.time_s - env.now)  # both on the grid, so the sum is exact
        floor.report(ARRIVAL, source.rank, number, ORDERED, (source, order))


def _arrived(floor: Floor, source: Source) -> None:
    for _ in range(source.plan.at_once):
        create(floor, source)


def _ordered(floor: Floor, ordered: tuple[Source, OrderPlan]) -> None:
    source, order = ordered
    for _ in range(order.quantity):
        job = new_job(floor, source, source.product(source.n_released))
        if order.due_s < inf:
            job.due_s = order.due_s
        if order.priority is not None:
            job.priority = order.priority
        want_in(floor, job)


HANDLERS: dict[str, Handler] = {ARRIVED: _arrived, ORDERED: _ordered}
