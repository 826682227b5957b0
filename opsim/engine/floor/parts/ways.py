"""What jobs are made, and where they go on: in turn, or drawn by the number of the job."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined, new_ints
from opsim.engine.floor.parts.luck import MIX, ROUTING, START, number_at, stream_of
from opsim.engine.floor.parts.records import Product, Source, Way
from opsim.engine.floor.parts.state import Floor, Job


@inlined
def taken(way: Way, point: float) -> int:
    """The step that a number in [0, 1) decides for."""
    i = 0
    while i < way.n - 1 and point >= way.cumulative[i]:
        i += 1
    return way.to[i]


@inlined
def first_step(floor: Floor, source: int, n: int, product: Product) -> int:
    """Where the n-th job of a source begins, drawn where there is a choice."""
    start = product.start
    if start.n == 1:
        return start.to[0]
    chances = product.start_chances
    while len(chances) <= source:
        chances.append(stream_of(floor, START, len(chances), 0, 0))
    return taken(start, number_at(floor, chances[source], n))


@inlined
def step_after(floor: Floor, job: Job) -> int:
    """The step of the route that follows, -1 for the way out; drawn by job number and visit where there is a choice."""
    here = job.plan.steps[job.step]
    way = here.way
    if way.n == 1:
        return way.to[0]
    if not job.visits:
        job.visits = new_ints(floor, job.plan.n_steps)
    visit = job.visits[job.step]
    job.visits[job.step] = visit + 1
    which = visit * floor.n_sources + job.source
    chances = here.chances
    while len(chances) <= which:
        n = len(chances)
        stream = stream_of(floor, ROUTING, job.operation, n % floor.n_sources, n // floor.n_sources)
        chances.append(stream)
    return taken(way, number_at(floor, chances[which], job.n))


@inlined
def product_of(floor: Floor, source: Source, n: int) -> int:
    """The rank of the product that the n-th job of a source is."""
    if source.n_sequence:
        return source.sequence[n % source.n_sequence]
    if source.n_orders and source.orders[0].product >= 0:
        low, high = 0, source.n_orders
        while high - low > 1:
            middle = (low + high) // 2
            if source.orders[middle].first <= n:
                low = middle
            else:
                high = middle
        return source.orders[low].product
    if source.n_mix <= 1:
        return source.ranks[0]
    if not source.mix:
        source.mix = stream_of(floor, MIX, source.rank, 0, 0)
    return int(number_at(floor, source.mix, n))


@inlined
def aim(job: Job, step: int) -> None:
    """The job's next operation is that of a step of its route."""
    job.step = step
    found = job.plan.steps[step]
    job.operation = found.operation
    job.gate = found.gate
