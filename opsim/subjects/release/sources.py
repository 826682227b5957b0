"""Sources of a time of their own: what SimPy does by a process for each of them.

Base stock: a job is begun whenever a store lacks a piece, those on the way and those waited for counted.
"""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.event_list import INF, new_event, on_grid, push_event
from opsim.engine.floor.floor_state import Floor, Source
from opsim.engine.floor.flow import create, new_job
from opsim.engine.floor.machine import Call, cast, here, inlined, line_of, step
from opsim.engine.floor.random_numbers import GAP, next_number, stream_of
from opsim.engine.floor.state import Event, Job
from opsim.engine.rules import ARRIVAL
from opsim.subjects.material.assembly import waited_for
from opsim.subjects.material.stores import Refill
from opsim.subjects.release.plan import BASE_STOCK
from opsim.subjects.routes.routing import product_of, want_in

BY_TIME, BY_ORDER, BY_FLOOR = range(3)
"""Kinds of sources: with gaps, with a schedule, and those that are asked."""
_as_source = cast(Source)


@step
def open_source(floor: Floor, source: Source) -> None:
    """Set a source going."""
    if source.kind == BY_TIME:
        source.gaps = stream_of(floor, GAP, source.rank, 0, 0)
        _wait_for_next(floor, source)
    elif source.kind == BY_ORDER:
        _go_through_orders(floor, source)


@step
def source_happens(floor: Floor, event: Event) -> None:
    """The time of the next arrival, or order, of a source has come: it is reported, and the one after it waited for."""
    source: Source = _as_source(event.subject)
    if source.kind == BY_TIME:
        source.n_arrived += 1
        floor.report_line(floor, event)
        _waits(floor, source)
    else:
        source.next_order += 1
        floor.report_line(floor, event)
        _go_through_orders(floor, source)


@inlined
def _report_of(floor: Floor, source: Source, line: Call, number: int) -> Event:
    event: Event = new_event(floor)
    event.line, event.alive, event.kind, event.rank, event.number = line, 1, ARRIVAL, source.rank, number
    event.subject = source
    return event


@step
def _wait_for_next(floor: Floor, source: Source) -> None:
    """The next arrival is a gap away; where the source has hours, a gap of open time."""
    left_s = on_grid(next_number(floor, source.gaps))
    delay_s = left_s
    if source.n_hours >= 0:
        while left_s >= source.until_s - source.at_s:
            left_s -= source.until_s - source.at_s
            if source.next_hour == source.n_hours:
                return
            source.at_s = source.hours[2 * source.next_hour]
            source.until_s = source.hours[2 * source.next_hour + 1]
            source.next_hour += 1
            if source.at_s == INF:
                return
        source.at_s += left_s
        delay_s = source.at_s - floor.env_now
    event = _report_of(floor, source, line_of_arrived, source.n_arrived)
    push_event(floor, floor.env_now + delay_s, event)


@step
def _go_through_orders(floor: Floor, source: Source) -> None:
    """Report the orders whose time has come, and wait for the next."""
    while source.next_order < source.n_orders:
        order = source.orders[source.next_order]
        event = _report_of(floor, source, line_of_ordered, source.next_order)
        if order.time_s > floor.env_now:
            push_event(floor, floor.env_now + (order.time_s - floor.env_now), event)
            return
        source.next_order += 1
        floor.report_line(floor, event)


@step
def arrived(floor: Floor, event: Event) -> None:
    """Jobs of a source come in."""
    source: Source = _as_source(event.subject)
    for _ in range(source.at_once):
        _create(floor, source)


@step
def ordered(floor: Floor, event: Event) -> None:
    """The jobs of an order come in, with its due date and priority where it has them."""
    source: Source = _as_source(event.subject)
    order = source.orders[event.number]
    for _ in range(order.quantity):
        job = new_job(floor, source, product_of(floor, source, source.n_released), -1, -1, -1)
        if order.due_s < INF:
            job.due_s = order.due_s
        if order.priority == order.priority:  # not NaN
            job.priority = order.priority
        want_in(floor, job, job.since_s)


line_of_arrived, line_of_ordered = line_of(arrived), line_of(ordered)
_create, _waits = here(create), here(_wait_for_next)
_stock_wanted, _waited = inlined(rules.stock_wanted), here(waited_for)


@step
def created(floor: Floor, refill: Refill, job: Job) -> None:
    """One more of its product is on the floor."""
    refill.n_jobs[job.product] += 1


@step
def left(floor: Floor, refill: Refill, job: Job) -> None:
    """One less."""
    refill.n_jobs[job.product] -= 1


@inlined
def _pieces(floor: Floor, refill: Refill, product: int) -> int:
    """Pieces of a product in its store and on the way there."""
    shelf = floor.stock.shelves[product]
    return shelf.units + (refill.n_jobs[product] - len(shelf.jobs)) * floor.products[product].lot


@step
def ask(floor: Floor, refill: Refill) -> bool:
    """Begin the jobs that are wanted; True where there were some."""
    began = False
    for i in range(refill.n_sources):
        source = refill.sources[i]
        product = source.ranks[0]
        if source.closed:
            continue
        while _stock_wanted(_pieces(floor, refill, product), _waited(floor, product), source.level):
            create(floor, source)
            began = True
    return began


def install_base_stock(build: Any) -> None:
    """Each store that is kept filled is looked at in every round of a settle step."""
    plan, floor = build.plan, build.floor
    sources = [build.sources[rank] for rank, source in enumerate(plan.sources) if source.kind == BASE_STOCK]
    if not sources:
        return
    refill = build.arena.new("Refill")
    refill.n_sources, refill.sources = len(sources), build.arena.array("Source", sources)
    refill.n_jobs = build.ints([0] * len(plan.products))
    build.hang(floor.created, created, refill)
    build.hang(floor.left_floor, left, refill)
    build.hang(floor.dispatchers, ask, refill)
