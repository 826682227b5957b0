"""Overtime: who stays on after his shift while jobs on the floor still need him."""

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import OUTSIDE, Worker
from opsim.plan import ProductPlan


class Needs:
    """to_come : by product and step, the stations that a job there may still come to, as bits of their ranks."""

    def __init__(self, floor: Floor):
        manned = [any(not floor.plan.tasks[task].automatic for task in station.tasks) for station in floor.stations]
        here = [
            [sum(1 << station.rank for station in gate.stations if manned[station.rank]) for _, _, gate in steps]
            for steps in floor.steps
        ]
        self.to_come = [_with_later(product, of_steps) for product, of_steps in zip(floor.plan.products, here)]

    def need(self, floor: Floor, worker: Worker) -> bool:
        """Whether he is at work, or a job on the floor has something before it that he may be sent to."""
        if worker.rank not in floor.free:
            return True
        skills, to_come = worker.skills, self.to_come
        return any(
            job.station is not OUTSIDE and to_come[job.product][job.step] & skills for job in floor.jobs.values()
        )


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
