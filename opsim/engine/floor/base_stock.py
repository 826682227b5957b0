"""Base stock: a job is begun whenever a store lacks a piece, those on the way and those waited for counted."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.kits import waited_for
from opsim.engine.floor.machine import here, inlined, step
from opsim.engine.floor.material import create
from opsim.engine.floor.parts.state import Floor, Job
from opsim.engine.floor.parts.stocks import Refill
from opsim.engine.rules import release
from opsim.plan.release import BASE_STOCK

_stock_wanted, _waited = inlined(release.stock_wanted), here(waited_for)


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


def install(build: Any) -> None:
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
