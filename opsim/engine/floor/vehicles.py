"""What the vehicles do right now, and which jobs call for them; and the rows of vehicles."""

from __future__ import annotations

from opsim.engine.floor.machine import cast, fresh, inlined, step
from opsim.engine.floor.parts.rows import new_row
from opsim.engine.floor.parts.state import Floor, Job, Station
from opsim.engine.floor.parts.vehicles import Leg, Pickup, Pool, Vehicle
from opsim.log import IDLE, PICKUP, TRANSPORT

FREE, COMING, LOADING, BRINGING, UNLOADING, GOING_HOME = range(6)
_new_pickup, _as_pickup = fresh(Pickup), cast(Pickup)


@inlined
def _is_before(one: Pickup, other: Pickup) -> bool:
    """Whether one is served before another."""
    if one.before != other.before:
        return one.before < other.before
    if one.since_s != other.since_s:
        return one.since_s < other.since_s
    return one.number < other.number


@step
def take_call(floor: Floor, leg: Leg, job: Job, station: Station) -> None:
    """A job calls, to be brought to a station."""
    call: Pickup = _new_pickup(floor)
    call.before, call.since_s, call.number = -job.priority, floor.now, job.number
    call.job, call.station, call.place_from = job, station, leg.place_from
    calls = leg.pool.calls
    at = len(calls)
    while at > 0 and _is_before(call, calls[at - 1]):
        at -= 1
    calls.insert(at, call)


@step
def next_call_at(floor: Floor, pool: Pool, place: int) -> Pickup:
    """The first call from a place, taken out; or nothing."""
    for at in range(len(pool.calls)):
        call = pool.calls[at]
        if call.place_from == place:
            del pool.calls[at]
            return call
    return _as_pickup(0)


@step
def now_does(floor: Floor, vehicle: Vehicle, doing: int, place: int) -> None:
    """The vehicle does something else from now on, at a place or on its way to it; what it did is written."""
    log_vehicle(floor, vehicle)
    if vehicle.doing == FREE:
        vehicle.pool.n_free -= 1
    if doing == FREE:
        vehicle.pool.n_free += 1
    vehicle.came_from, vehicle.place = vehicle.place, place
    vehicle.doing, vehicle.since_s = doing, floor.now


@step
def log_vehicle(floor: Floor, vehicle: Vehicle) -> None:
    """Write what the vehicle did until now, where it was not free: it drove, was loaded or unloaded."""
    if vehicle.doing == FREE or floor.now <= vehicle.since_s:
        return
    row = new_row(floor, TRANSPORT, vehicle.since_s)
    row.place_from, row.place_to, row.k = vehicle.came_from, vehicle.place, vehicle.number
    if vehicle.doing == COMING:
        row.cause = PICKUP
    elif vehicle.doing == GOING_HOME:
        row.cause = IDLE
