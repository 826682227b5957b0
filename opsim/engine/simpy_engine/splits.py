"""Disassembly: a job becomes several others, which share its server until the last of them has left."""

from functools import partial

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.material import go_to, leave_floor, new_job
from opsim.engine.simpy_engine.state import Job, Seat, Station
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import BLOCKED, SPLIT
from opsim.plan.splits import SplitPlan

ORDER = 20
"""Among what is asked when an operation is done."""


def install(floor: Floor) -> None:
    """A question at each station where jobs are split."""
    plans = floor.plan.splits
    for rank in sorted({split.station for split in plans}):
        here = {split.product: split for split in plans if split.station == rank}
        floor.stations[rank].add_after(ORDER, partial(_stays_whole, here))


def _stays_whole(here: dict[int, SplitPlan], floor: Floor, job: Job) -> bool:
    split = here.get(job.product)
    if split is None:
        return True
    station = job.station
    if job.held_by is not None:
        worker, job.held_by = job.held_by, None
        set_free(floor, worker)
    for told in floor.left_station:
        told(floor, job, station)
    leave_floor(floor, job, SPLIT, 0, station.rank)
    pieces = [piece for product, n in split.pieces for piece in _pieces(floor, split, job, product, n)]
    _share_seat(floor, station, job, pieces)
    for piece in pieces:
        go_to(floor, piece, piece.step)
    return False


def _pieces(floor: Floor, split: SplitPlan, job: Job, product: int, n: int) -> list[Job]:
    """The jobs of a product that a job becomes: whole lots, and what is left over."""
    source, most = next((s, most) for of, made, s, most in split.sources if (of, made) == (job.source, product))
    pieces: list[Job] = []
    station = job.station
    units = n * job.lot
    while units:
        number = job.n * most + len(pieces)
        piece = new_job(floor, floor.sources[source], product, number, station.rank, job.number)
        piece.lot = min(piece.lot, units)
        piece.bad, piece.station, piece.kind, piece.cause = job.bad, station, BLOCKED, 0
        units -= piece.lot
        pieces.append(piece)
    return pieces


def _share_seat(floor: Floor, station: Station, job: Job, pieces: list[Job]) -> None:
    """The pieces stand where the job stood: on one server, taking the room of as many jobs as they are."""
    seat = Seat(1) if job.seat is None else job.seat
    seat.n_jobs += len(pieces) - 1
    station.n_inside += len(pieces) - 1
    station.capacity += len(pieces) - 1
    if station.setups is not None and job.seat is None:  # the server stays set up as it is
        station.setups.of[seat] = station.setups.of.pop(job)
    job.seat = seat
    for piece in pieces:
        piece.seat = seat
        if station.seated is not None:
            station.seated.append(piece)
    if station.seated is not None:
        list.remove(station.seated, job)  # NOTE: not that of ``Servers``: the pieces have its server
