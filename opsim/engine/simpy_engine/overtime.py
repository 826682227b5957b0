"""Overtime: who stays on after his shift while jobs on the floor need him, and nobody whose shift it is."""

from collections.abc import Iterable

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import OUTSIDE, Station, Worker
from opsim.plan import ProductPlan
from opsim.plan.calendar import next_open


class Needs:
    """at_once : by station, how many workers its tasks take at most; 0 where it works alone

    to_come : by product and step, the stations that a job there may still come to, as bits of their ranks
    """

    def __init__(self, floor: Floor):
        self.at_once = [_at_once(floor, station) for station in floor.stations]
        here = [
            [sum(1 << station.rank for station in gate.stations) for _, _, gate in of_product]
            for of_product in floor.steps
        ]
        self.to_come = [_with_later(product, steps) for product, steps in zip(floor.plan.products, here)]

    def need(self, floor: Floor, worker: Worker, on_duty: Iterable[Worker], until_s: float) -> bool:
        """Whether a job on the floor has something before it that he can do until a time, and too few on duty can."""
        lacking = 0
        others = list(on_duty)
        for station in floor.stations:
            rank = station.rank
            if worker.rating[rank] > 0 and self.at_once[rank] and _opens_before(floor, station, until_s):
                able = sum(other.rating[rank] > 0 for other in others)
                lacking |= (able < self.at_once[rank]) << rank
        to_come = self.to_come
        return lacking > 0 and any(
            job.station is not OUTSIDE and to_come[job.product][job.step] & lacking for job in floor.jobs.values()
        )


def _at_once(floor: Floor, station: Station) -> int:
    tasks = [floor.plan.tasks[task] for task in station.tasks]
    return max((task.team for task in tasks if not task.automatic), default=0)


def _opens_before(floor: Floor, station: Station, until_s: float) -> bool:
    """Whether it is open, or will be before a time."""
    open_s = station.plan.open_s
    return open_s is None or next_open(open_s, floor.now) < until_s


def _with_later(product: ProductPlan, here: list[int]) -> list[int]:
    """Of each step the stations of it and of all that may follow."""
    found, before = list(here), None
    while found != before:
        before = list(found)
        for step, onward in enumerate(product.onward):
            for _, then in onward:
                if then >= 0:
                    found[step] |= found[then]
    return found
