"""Jobs brought by vehicles: called, loaded, driven, unloaded."""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.flow import leave_station
from opsim.engine.floor.log_rows import job_now, new_row
from opsim.engine.floor.machine import (
    NOTHING,
    Array,
    Handle,
    List,
    cast,
    drop,
    fresh,
    give_back,
    inlined,
    line_of,
    step,
    struct,
)
from opsim.engine.floor.state import Event, Job, Station
from opsim.engine.rules import COMPLETION
from opsim.log import HELD, IDLE, PICKUP, QUEUE, TRANSPORT
from opsim.subjects.people.worker import set_free
from opsim.subjects.routes.routing import alarm
from opsim.subjects.stations.station import arrive


@struct
class Pickup:
    """A job that waits for a vehicle, its place at the next station sure; calls are ordered as claims are."""

    before: float
    since_s: float
    number: int
    job: Job
    station: Station
    place_from: int


@struct
class Vehicle:
    """number : counted over all transporters; doing : one of FREE to GOING_HOME

    place, came_from : where it is, or drives to, and from where; since_s : since when it does what it does
    answers : the call it is on its way to, or loads; aboard : its jobs, first the one that was loaded first

    rank : where its reports come among those of an instant.
    """

    number: int
    rank: int
    pool: Pool
    place: int
    came_from: int
    doing: int
    since_s: float
    answers: Pickup
    aboard: List[Job]


@struct
class Leg:
    """From a station to another. place_from : where jobs are loaded."""

    pool: Pool
    place_from: int


@struct
class Pool:
    """The vehicles of a transporter. drive_s : by place and place; ready : for their next step; calls : in their order

    turns, idle : vehicles that are gone through just now: those that were ready, and those that are free
    """

    place: int
    capacity: int
    load_s: float
    unload_s: float
    goes_home: int
    drive_s: Array[float]
    n_vehicles: int
    vehicles: Array[Vehicle]
    calls: List[Pickup]
    ready: List[Vehicle]
    n_free: int
    turns: List[Vehicle]
    idle: List[Vehicle]


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


_soonest_there, _nearest_stop = inlined(rules.soonest_there), inlined(rules.nearest_stop)
_as_vehicle, _forget_pickup = cast(Vehicle), give_back(Pickup)


@step
def call_vehicle(floor: Floor, leg: Leg, job: Job, station: Station) -> None:
    """The job, whose place is sure, waits where it is; nobody has to stay with it."""
    job_now(floor, job, QUEUE if job.kind == QUEUE else HELD, PICKUP)
    if job.held_by and not floor.held_when_blocked:
        worker = job.held_by
        job.held_by = NOTHING
        set_free(floor, worker)
    take_call(floor, leg, job, station)


@step
def see_to_vehicles(floor: Floor, pool: Pool) -> bool:
    """Vehicles that are ready do their next step, and free ones are sent; True where something was done."""
    changed, turns = False, pool.turns
    while len(pool.ready) > 0 or (len(pool.calls) > 0 and pool.n_free > 0):
        turns.clear()
        for i in range(len(pool.ready)):
            vehicle, at = pool.ready[i], i
            while at > 0 and turns[at - 1].number > vehicle.number:
                at -= 1
            turns.insert(at, vehicle)
        pool.ready.clear()
        for one in turns:
            _next_step(floor, one)
        _send(floor, pool)
        changed = True
    return changed


@inlined
def _drive_s(floor: Floor, pool: Pool, start: int, end: int) -> float:
    return pool.drive_s[start * floor.n_places + end]


@inlined
def _soonest(floor: Floor, pool: Pool, place: int) -> int:
    """The number among the idle of that one who is soonest at a place."""
    at = 0
    for i in range(1, len(pool.idle)):
        one, best = pool.idle[i], pool.idle[at]
        found = _soonest_there(_drive_s(floor, pool, one.place, place), one.number)
        if found < _soonest_there(_drive_s(floor, pool, best.place, place), best.number):
            at = i
    return at


@step
def _send(floor: Floor, pool: Pool) -> None:
    idle = pool.idle
    idle.clear()
    for i in range(pool.n_vehicles):
        if pool.vehicles[i].doing == FREE:
            idle.append(pool.vehicles[i])
    while len(idle) > 0 and len(pool.calls) > 0:
        call = pool.calls.pop(0)
        at = _soonest(floor, pool, call.place_from)
        vehicle = idle[at]
        del idle[at]
        vehicle.answers = call
        _drive(floor, vehicle, COMING, call.place_from)
    if pool.goes_home:
        for one in idle:
            if one.place != pool.place:
                _drive(floor, one, GOING_HOME, pool.place)


@step
def _next_step(floor: Floor, vehicle: Vehicle) -> None:
    """What the vehicle does where it stands now: load, unload, drive on, or nothing."""
    pool = vehicle.pool
    if vehicle.doing == GOING_HOME:
        _be_free(floor, vehicle)
        return
    if (vehicle.doing == COMING or vehicle.doing == LOADING) and _has_next_call(floor, vehicle):
        _spend(floor, vehicle, LOADING, vehicle.place, pool.load_s)
        return
    if (vehicle.doing == BRINGING or vehicle.doing == UNLOADING) and _first_for(vehicle) >= 0:
        _spend(floor, vehicle, UNLOADING, vehicle.place, pool.unload_s)
        return
    if vehicle.aboard:
        _drive(floor, vehicle, BRINGING, _nearest_goal(floor, vehicle))
    else:
        _be_free(floor, vehicle)


@inlined
def _nearest_goal(floor: Floor, vehicle: Vehicle) -> int:
    """Of the places where something aboard goes, the nearest."""
    found = _goal(vehicle.aboard[0])
    for i in range(1, len(vehicle.aboard)):
        goal = _goal(vehicle.aboard[i])
        key = _nearest_stop(_drive_s(floor, vehicle.pool, vehicle.place, goal), goal)
        if key < _nearest_stop(_drive_s(floor, vehicle.pool, vehicle.place, found), found):
            found = goal
    return found


@step
def _has_next_call(floor: Floor, vehicle: Vehicle) -> bool:
    """Whether it answers the call it came for, or now what else waits here, as far as there is room."""
    if vehicle.answers:
        return True
    if len(vehicle.aboard) >= vehicle.pool.capacity:
        return False
    call = next_call_at(floor, vehicle.pool, vehicle.place)
    if not call:
        return False
    vehicle.answers = call
    return True


@step
def _drive(floor: Floor, vehicle: Vehicle, doing: int, place: int) -> None:
    _spend(floor, vehicle, doing, place, _drive_s(floor, vehicle.pool, vehicle.place, place))


@step
def _spend(floor: Floor, vehicle: Vehicle, doing: int, place: int, delay_s: float) -> None:
    """Do something from now on that takes some time, or none."""
    now_does(floor, vehicle, doing, place)
    if delay_s > 0:
        alarm(floor, delay_s, COMPLETION, vehicle.rank, 0, line_of_step_done, vehicle)
    else:
        _done(floor, vehicle)


@step
def step_done(floor: Floor, event: Event) -> None:
    """A vehicle is done."""
    _done(floor, _as_vehicle(event.subject))


@step
def _done(floor: Floor, vehicle: Vehicle) -> None:
    """What the vehicle did is over; what it does next is decided when everybody has come to this instant."""
    if vehicle.doing == LOADING:
        _loaded(floor, vehicle)
    elif vehicle.doing == UNLOADING:
        _unloaded(floor, vehicle)
    vehicle.pool.ready.append(vehicle)


@step
def _loaded(floor: Floor, vehicle: Vehicle) -> None:
    """The job is on the vehicle, and its station is rid of it."""
    call = vehicle.answers
    vehicle.answers = NOTHING
    job, station = call.job, call.station
    _forget_pickup(floor, call)
    job_now(floor, job, TRANSPORT, 0)
    leave_station(floor, job)
    job.station = station
    vehicle.aboard.append(job)


@step
def _unloaded(floor: Floor, vehicle: Vehicle) -> None:
    """The first of the jobs that go here is at its station."""
    job = vehicle.aboard[_first_for(vehicle)]
    drop(vehicle.aboard, job)
    job_now(floor, job, QUEUE, 0)
    arrive(floor, job.station, job)


@inlined
def _goal(job: Job) -> int:
    return job.station.place


@inlined
def _first_for(vehicle: Vehicle) -> int:
    """The number of the first job aboard that goes where the vehicle is; -1: none does."""
    for i in range(len(vehicle.aboard)):
        if _goal(vehicle.aboard[i]) == vehicle.place:
            return i
    return -1


@step
def _be_free(floor: Floor, vehicle: Vehicle) -> None:
    now_does(floor, vehicle, FREE, vehicle.place)


@step
def close_vehicles(floor: Floor, pool: Pool) -> bool:
    """What vehicles do at the horizon is written."""
    for i in range(pool.n_vehicles):
        log_vehicle(floor, pool.vehicles[i])
    return False


line_of_step_done = line_of(step_done)


def install(build: Any) -> None:
    """Vehicles stand at their places, and jobs of their legs call for them."""
    plan, floor = build.plan, build.floor
    if not plan.transporters:
        return
    number, n_stations, legs = 0, len(plan.stations), {}
    for one in plan.transporters:
        pool = _pool(build, one, number)
        number += one.n
        for leg in one.legs:
            made = build.arena.new("Leg")
            made.pool, made.place_from = pool, leg.place_from
            legs[leg.before * n_stations + leg.after] = build.hook(call_vehicle, made)
        build.hang(floor.dispatchers, see_to_vehicles, pool)
        build.hang(floor.closing, close_vehicles, pool)
    build.line(step_done)
    floor.has_legs = 1
    floor.legs = build.arena.array("Hook", [legs.get(i) for i in range(n_stations * n_stations)])


def _pool(build: Any, plan: Any, number: int) -> Handle:
    """number : of the first of its vehicles among all."""
    made, n_places = build.arena.new("Pool"), len(plan.distance_m)
    made.place, made.capacity, made.load_s, made.unload_s = plan.place, plan.capacity, plan.load_s, plan.unload_s
    made.goes_home, made.n_vehicles, made.n_free = plan.goes_home, plan.n, plan.n
    made.drive_s = build.floats(plan.drive_s(start, end) for start in range(n_places) for end in range(n_places))
    made.vehicles = build.arena.array("Vehicle", [_vehicle(build, made, number + i) for i in range(plan.n)])
    return made


def _vehicle(build: Any, pool: Handle, number: int) -> Handle:
    made = build.arena.new("Vehicle")
    made.number, made.pool, made.place, made.came_from = number, pool, pool.place, pool.place
    made.rank = len(build.plan.workers) + len(build.plan.stations) + number
    return made
