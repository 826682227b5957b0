"""Stores, what lies in them, and who waits for it.

Stores: products wait there until they are taken as parts, those that came first in front.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import Floor, Source
from opsim.engine.floor.flow import leave_floor, leave_station, new_job
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import Array, List, step, struct
from opsim.engine.floor.state import Claim, Job, Station
from opsim.log import JOIN, QUEUE, STOCK
from opsim.subjects.routes.routing import aim


@struct
class Shelf:
    """What lies in stores of one product. jobs : in the order in which they came; units : of lots, what is left."""

    jobs: List[Job]
    units: int


@struct
class Stock:
    """shelves : (P,); changed : whether something came since parts were given out."""

    shelves: Array[Shelf]
    changed: int


@struct
class Filling:
    """Jobs of a product that lie in a store at the start. step : of the route of the product, which is the store."""

    station: Station
    source: Source
    product: int
    n_jobs: int
    step: int


@struct
class Need:
    """n : of how many products a unit takes parts at a station, by rank; pieces : of each."""

    n: int
    products: Array[int]
    pieces: Array[int]


@struct
class Kits:
    """stations : where parts go in; needs : by station x products + product; claims : of jobs that wait for parts

    wanted : (P,) pieces that one of them waits for; waiting : those that are looked at in a round
    """

    n_stations: int
    stations: Array[Station]
    needs: Array[Need]
    claims: List[Claim]
    changed: int
    wanted: Array[int]
    waiting: List[Job]


@struct
class Refill:
    """Stores that are kept filled. n_jobs : (P,) jobs of each product on the floor, in stores too."""

    n_sources: int
    sources: Array[Source]
    n_jobs: Array[int]


@step
def take(floor: Floor, product: int, n: int, station: Station, into: Job) -> None:
    """Take pieces of a product for a job at a station, the oldest first; a lot that is used up joins the job."""
    shelf = floor.stock.shelves[product]
    shelf.units -= n
    while n:
        job = shelf.jobs[0]
        left = job.lot - job.block.taken
        job.block.taken = 0
        into.bad |= job.bad
        if left > n:
            job.block.taken = job.lot - left + n
            return
        n -= left
        shelf.jobs.pop(0)
        leave_station(floor, job)
        leave_floor(floor, job, JOIN, 0, station.rank, into.number)


@step
def receive(floor: Floor, station: Station, job: Job) -> None:
    """The job is in the store."""
    job_now(floor, job, QUEUE, STOCK)
    stock = floor.stock
    shelf = stock.shelves[job.product]
    shelf.jobs.append(job)
    shelf.units += job.lot
    stock.changed = 1


@step
def vacate(floor: Floor, station: Station, job: Job) -> None:
    """There is no server to give back."""


@step
def fill(floor: Floor, filling: Filling) -> bool:
    """The jobs of a product that lie in a store at the start."""
    station = filling.station
    for _ in range(filling.n_jobs):
        job = new_job(floor, filling.source, filling.product, -1, station.rank, -1)
        aim(job, filling.step)
        job.station = station
        station.n_inside += 1
        receive(floor, station, job)
    return True


def install(build: Any) -> None:
    """Stores take what comes, and hold what lies there at the start."""
    plan = build.plan
    if not plan.stores:
        return
    build.keep_jobs()
    stock = build.floor.stock = build.arena.new("Stock")
    stock.shelves = build.arena.array("Shelf", [build.arena.new("Shelf") for _ in plan.products])
    for store in plan.stores:
        station = build.stations[store.station]
        station.receive, station.vacate = build.hook(receive), build.hook(vacate)
    for store in plan.stores:
        for product, n_jobs in store.initial:
            _fill(build, store, product, n_jobs)


def _fill(build: Any, store: Any, product: int, n_jobs: int) -> None:
    filling = build.arena.new("Filling")
    filling.station, filling.source = build.stations[store.station], build.sources[store.source]
    filling.product, filling.n_jobs = product, n_jobs
    route = build.plan.products[product].route
    filling.step = next(i for i, operation in enumerate(route) if store.station in operation.stations)
    build.hang(build.floor.starts, fill, filling)
