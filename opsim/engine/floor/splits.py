"""Disassembly: a job becomes several others, which share its server until the last of them has left."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import NOTHING, drop, fresh, inlined, step
from opsim.engine.floor.material import go_to, leave_floor, new_job
from opsim.engine.floor.parts.records import Seat
from opsim.engine.floor.parts.splitting import Split, Splits
from opsim.engine.floor.parts.state import Floor, Job, Station
from opsim.engine.floor.station import see_seated
from opsim.engine.floor.worker import set_free
from opsim.log import BLOCKED, SPLIT

ORDER = 20
"""Among what is asked when an operation is done."""
_new_seat = fresh(Seat)


@step
def stays_whole(floor: Floor, splits: Splits, job: Job) -> bool:
    """Whether nothing becomes of the job here."""
    split = splits.of[job.product]
    if not split:
        return True
    station = job.station
    if job.held_by:
        worker = job.held_by
        job.held_by = NOTHING
        set_free(floor, worker)
    for told in floor.left_station:
        told.line(floor, told.subject, job, station)
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
    job.seat = shared
    piece = job.block.next_piece
    while piece:
        piece.seat = shared
        if station.has_seated:
            see_seated(floor, station, piece)
        piece = piece.block.next_piece
    if station.has_seated:
        drop(station.seated, job)  # its server goes to the pieces, and is not given back


def install(build: Any) -> None:
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
    made.n, made.n_ways = len(plan.pieces), len(plan.sources)
    made.products = build.ints(product for product, _ in plan.pieces)
    made.pieces = build.ints(n for _, n in plan.pieces)
    made.of, made.made, made.source, made.most = (build.ints(way[i] for way in plan.sources) for i in range(4))
    return made
