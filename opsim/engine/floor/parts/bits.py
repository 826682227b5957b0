"""Sets of stations as bits, a word for each 64 of them."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, inlined
from opsim.engine.floor.parts.state import Floor, Station, Worker


@inlined
def has_bit(bits: Array[int], rank: int) -> bool:
    """Whether a station is in the set."""
    return (bits[rank >> 6] >> (rank & 63)) & 1 == 1


@inlined
def set_bit(bits: Array[int], rank: int) -> None:
    bits[rank >> 6] |= 1 << (rank & 63)


@inlined
def clear_bit(bits: Array[int], rank: int) -> None:
    bits[rank >> 6] &= ~(1 << (rank & 63))


@inlined
def may_serve(worker: Worker, station: Station) -> bool:
    """Whether he may be sent to a station now."""
    return (worker.skills[station.rank >> 6] >> (station.rank & 63)) & 1 == 1


@inlined
def see_skills(floor: Floor, worker: Worker) -> None:
    """The stations that his ratings and all limits leave him."""
    floor.none_fits = 0
    for word in range(floor.n_words):
        left = worker.own_skills[word]
        for limit in range(floor.n_limits):
            if worker.limited[limit]:
                left &= worker.limits[limit * floor.n_words + word]
        worker.skills[word] = left


@inlined
def leave_none(floor: Floor, worker: Worker, limit: int) -> None:
    """A limit leaves him no station."""
    worker.limited[limit] = 1
    for word in range(floor.n_words):
        worker.limits[limit * floor.n_words + word] = 0
        worker.skills[word] = 0


@inlined
def leave_those(floor: Floor, worker: Worker, limit: int, stations: Array[int]) -> None:
    """A limit leaves him some stations."""
    worker.limited[limit] = 1
    for word in range(floor.n_words):
        worker.limits[limit * floor.n_words + word] = stations[word]
    see_skills(floor, worker)


@inlined
def leave_all(floor: Floor, worker: Worker, limit: int) -> None:
    """A limit holds no more."""
    worker.limited[limit] = 0
    see_skills(floor, worker)
