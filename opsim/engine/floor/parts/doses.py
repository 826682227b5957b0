"""What each worker's body has gone through so far. See ``doses``."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, address_of, call_out, inlined, struct
from opsim.engine.floor.parts.state import Floor, Worker


@struct
class Dose:
    """Of one worker. rates : by task, NaN where nobody has asked; ask_rate, ask_order : addresses of what to ask

    before : of all that is over; per_s, since_s, until_s : of what he is at, or was at last
    """

    before: float
    per_s: float
    since_s: float
    until_s: float
    rates: Array[float]
    ask_rate: int
    ask_order: int


@inlined
def dose_so_far(floor: Floor, worker: Worker) -> float:
    """Until now."""
    dose = worker.dose
    return dose.before + dose.per_s * (min(floor.now, dose.until_s) - dose.since_s)


@inlined
def rate_of(floor: Floor, worker: Worker, task: int) -> float:
    """RULA x seconds of a second of his work."""
    dose = worker.dose
    if dose.rates[task] != dose.rates[task]:  # NaN
        call_out(dose.ask_rate, worker.rank, task)
    return dose.rates[task]


@inlined
def heaviest_first(floor: Floor, worker: Worker, rotation: int, order: Array[int]) -> None:
    """Numbers of the posts of a rotation by how much they add to a body; ``worker`` : any who has a dose.

    NOTE: Python sums it, which is not the same in all its versions.
    """
    call_out(worker.dose.ask_order, rotation, address_of(order))
