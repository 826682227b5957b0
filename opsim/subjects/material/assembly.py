"""Assembly: a job on its server waits until all its parts are in the stores, and takes them all at once.

Disassembly: a job becomes several others, which share its server until the last of them has left.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.flow import go_to, leave_floor, new_job, part_with_station
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import Array, drop, fresh, give_items_back, inlined, step, struct
from opsim.engine.floor.records import Seat
from opsim.engine.floor.state import Job, Station
from opsim.log import BLOCKED, HELD, NO_PARTS, SPLIT
from opsim.subjects.material.stores import Kits, take
from opsim.subjects.routes.routing import claim_at, give_up_claims, put_claim, take_claim
from opsim.subjects.stations.station import proceed, see_seated

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


def install_kits(build: Any) -> None:
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


@struct
class Split:
    """n : products of pieces; products, pieces : of each, how many a unit becomes

    source : of pieces: of jobs of the source ``of``, those of the product ``made`` come from ``source``, at
    most ``most`` of them a job
    """

    n: int
    products: Array[int]
    pieces: Array[int]
    of: Array[int]
    made: Array[int]
    source: Array[int]
    most: Array[int]


@struct
class Splits:
    """Of a station. of : (P,) what becomes of each product there, or nothing."""

    of: Array[Split]


"""Among what is asked when an operation is done."""
_new_seat = fresh(Seat)


@step
def stays_whole(floor: Floor, splits: Splits, job: Job) -> bool:
    """Whether nothing becomes of the job here."""
    split = splits.of[job.product]
    if not split:
        return True
    station = job.station
    part_with_station(floor, job)
    leave_floor(floor, job, SPLIT, 0, station.rank, -1)
    n = _make_pieces(floor, split, job)
    _share_seat(floor, station, job, n)
    piece = job.block.next_piece
    while piece:
        go_to(floor, piece, piece.step)
        piece = piece.block.next_piece
    return False


@inlined
def _way(split: Split, source: int, product: int) -> int:
    """Which of the sources of pieces is that of a product's, of jobs of a source. There is one."""
    at = 0
    while split.of[at] != source or split.made[at] != product:
        at += 1
    return at


@step
def _make_pieces(floor: Floor, split: Split, job: Job) -> int:
    """The jobs that a job becomes, one behind the other, of each product whole lots and what is left over; how many."""
    n_pieces = 0
    last = job
    for i in range(split.n):
        way = _way(split, job.source, split.products[i])
        units, n_made = split.pieces[i] * job.lot, 0
        while units:
            number = job.n * split.most[way] + n_made
            source = floor.sources[split.source[way]]
            piece = new_job(floor, source, split.products[i], number, job.station.rank, job.number)
            piece.lot = min(piece.lot, units)
            piece.bad, piece.station, piece.kind, piece.cause = job.bad, job.station, BLOCKED, 0
            units -= piece.lot
            n_made += 1
            last.block.next_piece = piece
            last = piece
        n_pieces += n_made
    return n_pieces


@step
def _share_seat(floor: Floor, station: Station, job: Job, n: int) -> None:
    """The n pieces stand where the job stood: on one server, taking the room of as many jobs as they are."""
    shared: Seat = job.seat
    if not shared:
        shared = _new_seat(floor)
        shared.n_jobs = 1
        if station.setups:  # the server stays set up as it is
            shared.setup = job.block.server
            job.block.server = 0
    shared.n_jobs += n - 1
    station.n_inside += n - 1
    station.capacity += n - 1
    floor.entries_full = 0
    job.seat = shared
    piece = job.block.next_piece
    while piece:
        piece.seat = shared
        if station.has_seated:
            see_seated(floor, station, piece)
        piece = piece.block.next_piece
    if station.has_seated:
        drop(station.seated, job)  # its server goes to the pieces, and is not given back


def install_splits(build: Any) -> None:
    """A question at each station where jobs are split."""
    plans = build.plan.splits
    for rank in sorted({split.station for split in plans}):
        build.keep_jobs()
        made: list[Any] = [None] * len(build.plan.products)
        for split in plans:
            if split.station == rank:
                made[split.product] = _split(build, split)
        splits = build.arena.new("Splits")
        splits.of = build.arena.array("Split", made)
        build.hang(build.stations[rank].afters, stays_whole, splits, ORDER)


def _split(build: Any, plan: Any) -> Any:
    made = build.arena.new("Split")
    made.n = len(plan.pieces)
    made.products = build.ints(product for product, _ in plan.pieces)
    made.pieces = build.ints(n for _, n in plan.pieces)
    made.of, made.made, made.source, made.most = (build.ints(way[i] for way in plan.sources) for i in range(4))
    return made
