"""Bills of material: a job on its server waits until all its parts are in the stores, and takes them all at once."""

from bisect import insort
from collections import Counter

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Claim, Job, Station, claim_of
from opsim.engine.simpy_engine.station import proceed
from opsim.engine.simpy_engine.stores import take
from opsim.log import HELD, NO_PARTS

ORDER = 20
"""Among the preparations of a job on its server."""


class Kits:
    """needs : by (station, product), the parts of a unit; given : by job number, the stations where it had its parts

    claims  : of jobs that wait for parts, met in their order; one that cannot be met does not hold up those behind it
    """

    def __init__(self, floor: Floor) -> None:
        self.stations = sorted({kit.station for kit in floor.plan.kits})
        self.needs = {(kit.station, kit.product): kit.parts for kit in floor.plan.kits}
        self.claims: list[Claim] = []
        self.given: dict[int, set[int]] = {}
        self.changed = False

    def has_parts(self, floor: Floor, job: Job) -> bool:
        """Whether the job, with those of its batch, has its parts, or needs none; else it waits for them."""
        if not self.wanted(job):
            return True
        self.claims = [claim for claim in self.claims if claim[3] is not job]
        floor.job_now(job, HELD, NO_PARTS)
        insort(self.claims, claim_of(job, floor.now))
        self.changed = True
        return False

    def wanted(self, job: Job) -> Counter[int]:
        """Pieces by product that a job, with those of its batch, still needs at its station."""
        station = job.station
        wanted: Counter[int] = Counter()
        for one in (job, *job.members):
            for product, pieces in self._parts(station, one):
                wanted[product] += pieces
        return wanted

    def _parts(self, station: Station, job: Job) -> list[tuple[int, int]]:
        """(product, pieces) that one job still needs at a station."""
        if station.rank in self.given.get(job.number, ()):
            return []
        return [(product, pieces * job.lot) for product, pieces in self.needs.get((station.rank, job.product), ())]

    def give_out(self, floor: Floor) -> bool:
        """Parts go to the jobs that wait for them; True where some did."""
        if not (self.changed or floor.stock.changed):
            return False
        self.changed = floor.stock.changed = False
        return sum(self._give(floor, claim) for claim in tuple(self.claims)) > 0

    def _give(self, floor: Floor, claim: Claim) -> bool:
        job, wanted = claim[3], Counter[int]()
        waits = job.kind == HELD and job.cause == NO_PARTS
        if waits:
            wanted = self.wanted(job)
            if any(floor.stock.units[product] < pieces for product, pieces in wanted.items()):
                return False
        self.claims.remove(claim)
        if not waits:  # it was taken off its server meanwhile, and will ask again
            return False
        station = job.station
        for one in (job, *job.members):
            for product, pieces in sorted(self._parts(station, one)):
                take(floor, product, pieces, station, one)
            self.given.setdefault(one.number, set()).add(station.rank)
        proceed(floor, job)
        return True

    def forget(self, _floor: Floor, job: Job) -> None:
        """A job that is gone."""
        self.given.pop(job.number, None)


def install(floor: Floor) -> None:
    """A preparation at each station where parts go in."""
    if not floor.plan.kits:
        return
    kits = floor.kits = Kits(floor)
    for rank in kits.stations:
        floor.stations[rank].add_stage(ORDER, kits.has_parts)
    floor.left_floor.append(kits.forget)
    floor.dispatchers.append(kits.give_out)


def waited_for(floor: Floor, product: int) -> int:
    """Pieces of a product that are wanted now: by jobs that wait for their parts, and by those in line behind them."""
    kits = floor.kits
    if kits is None:
        return 0
    waiting = [claim[3] for claim in kits.claims]
    waiting += [job for rank in kits.stations for job in floor.stations[rank].queue]
    return sum(kits.wanted(job)[product] for job in waiting)
