"""Bills of material: a job on its server waits until all its parts are in the stores, and takes them all at once."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import give_items_back, step
from opsim.engine.floor.parts.claims import claim_at, give_up_claims, put_claim, take_claim
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import Floor, Job
from opsim.engine.floor.parts.stocks import Kits
from opsim.engine.floor.station import proceed
from opsim.engine.floor.stores import take
from opsim.log import HELD, NO_PARTS

ORDER = 20
"""Among the preparations of a job on its server."""


@step
def has_parts(floor: Floor, kits: Kits, job: Job) -> bool:
    """Whether the job, with those of its batch, has its parts, or needs none; else it waits for them."""
    wants = _needs_some(floor, kits, job)
    for other in job.members:
        wants = wants or _needs_some(floor, kits, other)
    if not wants:
        return True
    give_up_claims(floor, kits.claims, job)
    job_now(floor, job, HELD, NO_PARTS)
    put_claim(floor, kits.claims, job, floor.now)
    kits.changed = 1
    return False


@step
def _needs_some(floor: Floor, kits: Kits, job: Job) -> bool:
    """Whether one job still needs parts at its station. A member of a batch is where the first of it is."""
    need = kits.needs[job.station.rank * floor.n_products + job.product]
    if not need:
        return False
    return job.station.rank not in job.block.given


@step
def give_out(floor: Floor, kits: Kits) -> bool:
    """Parts go to the jobs that wait for them; True where some did."""
    if not kits.changed and not floor.stock.changed:
        return False
    kits.changed = floor.stock.changed = 0
    kits.waiting.clear()
    for claim in kits.claims:  # those that come to wait meanwhile are looked at in the next round
        kits.waiting.append(claim.job)
    n_given = 0
    for one in kits.waiting:
        if _give(floor, kits, one):
            n_given += 1
    return n_given > 0


@step
def _give(floor: Floor, kits: Kits, job: Job) -> bool:
    """The job has its parts, with those of its batch, where they are all there; True where it has."""
    waits = job.kind == HELD and job.cause == NO_PARTS
    if waits:
        _want(floor, kits, job)
        for product in range(floor.n_products):
            if floor.stock.shelves[product].units < kits.wanted[product]:
                return False
    at = claim_at(kits.claims, job)
    if at >= 0:
        take_claim(floor, kits.claims, at)
    if not waits:  # it was taken off its server meanwhile, and will ask again
        return False
    _take_all(floor, kits, job)
    for other in job.members:
        _take_all(floor, kits, other)
    proceed(floor, job, floor.no_worker)
    return True


@step
def _want(floor: Floor, kits: Kits, job: Job) -> None:
    """Pieces by product that a job, with those of its batch, still needs at its station."""
    for product in range(floor.n_products):
        kits.wanted[product] = 0
    _add(floor, kits, job)
    for other in job.members:
        _add(floor, kits, other)


@step
def _add(floor: Floor, kits: Kits, job: Job) -> None:
    if _needs_some(floor, kits, job):
        need = kits.needs[job.station.rank * floor.n_products + job.product]
        for i in range(need.n):
            kits.wanted[need.products[i]] += need.pieces[i] * job.lot


@step
def _take_all(floor: Floor, kits: Kits, job: Job) -> None:
    """One job takes all the parts that it still needs."""
    station = job.station
    if _needs_some(floor, kits, job):
        need = kits.needs[station.rank * floor.n_products + job.product]
        for i in range(need.n):
            take(floor, need.products[i], need.pieces[i] * job.lot, station, job)
    if station.rank not in job.block.given:
        job.block.given.append(station.rank)


@step
def forget(floor: Floor, kits: Kits, job: Job) -> None:
    """A job that is gone."""
    give_items_back(floor, job.block.given)


@step
def waited_for(floor: Floor, product: int) -> int:
    """Pieces of a product that are wanted now: by jobs that wait for their parts, and by those in line behind them."""
    kits = floor.kits
    if not kits:
        return 0
    total = 0
    for claim in kits.claims:
        total += _wanted_of(floor, kits, claim.job, product)
    for i in range(kits.n_stations):
        queue = kits.stations[i].queue
        for one in queue:
            total += _wanted_of(floor, kits, one, product)
    return total


@step
def _wanted_of(floor: Floor, kits: Kits, job: Job, product: int) -> int:
    total = _wanted_by(floor, kits, job, product)
    for other in job.members:
        total += _wanted_by(floor, kits, other, product)
    return total


@step
def _wanted_by(floor: Floor, kits: Kits, job: Job, product: int) -> int:
    if not _needs_some(floor, kits, job):
        return 0
    need = kits.needs[job.station.rank * floor.n_products + job.product]
    for i in range(need.n):
        if need.products[i] == product:
            return need.pieces[i] * job.lot
    return 0


def install(build: Any) -> None:
    """A preparation at each station where parts go in."""
    plan = build.plan
    if not plan.kits:
        return
    build.keep_jobs()
    kits = build.floor.kits = build.arena.new("Kits")
    ranks = sorted({kit.station for kit in plan.kits})
    kits.n_stations = len(ranks)
    kits.stations = build.arena.array("Station", [build.stations[rank] for rank in ranks])
    needs: list[Any] = [None] * (len(plan.stations) * len(plan.products))
    for kit in plan.kits:
        need = needs[kit.station * len(plan.products) + kit.product] = build.arena.new("Need")
        need.n = len(kit.parts)
        need.products = build.ints(product for product, _ in sorted(kit.parts))
        need.pieces = build.ints(pieces for _, pieces in sorted(kit.parts))
    kits.needs, kits.wanted = build.arena.array("Need", needs), build.ints([0] * len(plan.products))
    for rank in ranks:
        build.hang(build.stations[rank].stages, has_parts, kits, ORDER)
    build.hang(build.floor.left_floor, forget, kits)
    build.hang(build.floor.dispatchers, give_out, kits)
