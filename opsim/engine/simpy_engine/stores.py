"""Stores: products wait there until they are taken as parts, those that came first in front."""

from collections import deque

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.material import aim, leave_floor, leave_station, new_job
from opsim.engine.simpy_engine.state import Job, Station
from opsim.log import JOIN, QUEUE, STOCK
from opsim.plan.stores import StorePlan


class Stock:
    """What lies in all stores, by product.

    jobs    : (P,) jobs in the order in which they came; units : (P,) pieces, of lots those that are left
    taken   : by job number, pieces that were taken out of a lot; changed: something came since parts were given out
    """

    def __init__(self, n_products: int) -> None:
        self.jobs: list[deque[Job]] = [deque() for _ in range(n_products)]
        self.units = [0] * n_products
        self.taken: dict[int, int] = {}
        self.changed = False


def install(floor: Floor) -> None:
    """Stores take what comes, and hold what lies there at the start."""
    if not floor.plan.stores:
        return
    floor.stock = Stock(len(floor.plan.products))
    for store in floor.plan.stores:
        station = floor.stations[store.station]
        station.receive, station.vacate = _receive, _vacate
    for store in floor.plan.stores:
        _fill(floor, store)


def take(floor: Floor, product: int, n: int, station: Station, into: Job) -> None:
    """Take pieces of a product for a job at a station, the oldest first; a lot that is used up joins the job."""
    stock: Stock = floor.stock
    stock.units[product] -= n
    while n:
        job = stock.jobs[product][0]
        left = job.lot - stock.taken.pop(job.number, 0)
        into.bad |= job.bad
        if left > n:
            stock.taken[job.number] = job.lot - left + n
            return
        n -= left
        stock.jobs[product].popleft()
        leave_station(floor, job)
        leave_floor(floor, job, JOIN, 0, station.rank, into.number)


def _receive(floor: Floor, _station: Station, job: Job) -> None:
    floor.job_now(job, QUEUE, STOCK)
    stock: Stock = floor.stock
    stock.jobs[job.product].append(job)
    stock.units[job.product] += job.lot
    stock.changed = True


def _vacate(_floor: Floor, _station: Station, _job: Job) -> None:
    """There is no server to give back."""


def _fill(floor: Floor, store: StorePlan) -> None:
    """The jobs that lie in a store at the start."""
    station = floor.stations[store.station]
    for product, n_jobs in store.initial:
        step = _step_into(floor, product, station)
        for _ in range(n_jobs):
            job = new_job(floor, floor.sources[store.source], product, station=station.rank)
            aim(floor, job, step)
            job.station = station
            station.n_inside += 1
            _receive(floor, station, job)


def _step_into(floor: Floor, product: int, station: Station) -> int:
    """The step of a product's route that is a store."""
    return next(i for i, (_, _, gate) in enumerate(floor.steps[product]) if station in gate.stations)
