"""Base stock: a job is begun whenever a store lacks a piece, those on the way and those waited for counted."""

from opsim.engine.rules import stock_wanted
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.kits import waited_for
from opsim.engine.simpy_engine.material import create
from opsim.engine.simpy_engine.state import Job, Source
from opsim.plan.release import BASE_STOCK


def install(floor: Floor) -> None:
    """Each store that is kept filled is looked at in every round of a settle step."""
    sources = [source for source in floor.sources if source.plan.kind == BASE_STOCK]
    if sources:
        refill = Refill(floor, sources)
        floor.created.append(refill.created)
        floor.left_floor.append(refill.left)
        floor.dispatchers.append(refill.ask)


class Refill:
    """n_jobs : (P,) jobs of each product on the floor, in stores too."""

    def __init__(self, floor: Floor, sources: list[Source]):
        self.sources = sources
        self.n_jobs = [0] * len(floor.plan.products)
        for job in floor.jobs.values():
            self.n_jobs[job.product] += 1

    def created(self, _floor: Floor, job: Job) -> None:
        self.n_jobs[job.product] += 1

    def left(self, _floor: Floor, job: Job) -> None:
        self.n_jobs[job.product] -= 1

    def ask(self, floor: Floor) -> bool:
        """Begin the jobs that are wanted; True where there were some."""
        began = False
        for source in [one for one in self.sources if not one.closed]:
            product = source.plan.mix[0][0]
            while stock_wanted(self._pieces(floor, product), waited_for(floor, product), source.plan.level):
                create(floor, source)
                began = True
        return began

    def _pieces(self, floor: Floor, product: int) -> int:
        """Pieces of a product in its store and on the way there."""
        on_the_way = self.n_jobs[product] - len(floor.stock.jobs[product])
        return floor.stock.units[product] + on_the_way * floor.plan.products[product].lot
