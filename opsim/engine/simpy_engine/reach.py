"""What jobs can come to in time: through stations that work alone, or where somebody is; not past a run that lasts."""

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Station
from opsim.log import QUEUE, SETUP, TRANSPORT, WORK
from opsim.plan import ProductPlan


class Reach:
    """here : by product and step, the stations of it, as bits of their ranks

    known : by the stations that are asked for, and those that jobs get through: by product and step, whether one there
            comes to any that is asked for
    """

    def __init__(self, floor: Floor):
        self.products = floor.plan.products
        self.here = [
            [sum(1 << station.rank for station in gate.stations) for _, _, gate in of_product]
            for of_product in floor.steps
        ]
        self.known: dict[tuple[int, int], list[list[bool]]] = {}

    def of(self, wanted: int, passed: int) -> list[list[bool]]:
        """By product and step, whether a job comes to stations that are wanted, through those that are passed."""
        found = self.known.get((wanted, passed))
        if found is None:
            ways = zip(self.products, self.here)
            found = self.known[wanted, passed] = [_comes(product, here, wanted, passed) for product, here in ways]
        return found


def _comes(product: ProductPlan, here: list[int], wanted: int, passed: int) -> list[bool]:
    found, before = [stations & wanted > 0 for stations in here], None
    while found != before:
        before = list(found)
        for step, onward in enumerate(product.onward):
            if here[step] & passed and any(then >= 0 and found[then] for _, then in onward):
                found[step] = True
    return found


def lasts(job: Job, until_s: float) -> bool:
    """Whether an automatic run of a job is under way that is not over before a time."""
    runs = job.kind in (WORK, SETUP) and job.worker < 0 and job.team is None
    return runs and job.since_s + job.duration_s >= until_s


def held_up(floor: Floor, until_s: float) -> int:
    """The stations, as bits, where runs that last until some time have all servers: nobody else gets in before it."""
    inside: dict[Station, bool] = {}
    for job in floor.jobs.values():
        if job.kind not in (QUEUE, TRANSPORT):
            inside[job.station] = inside.get(job.station, True) and lasts(job, until_s)
    return sum(1 << station.rank for station, all_last in inside.items() if all_last and not station.free_servers)
