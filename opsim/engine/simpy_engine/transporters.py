"""Jobs brought by vehicles: called, loaded, driven, unloaded."""

from functools import partial

from opsim.engine.rules import COMPLETION, nearest_stop, soonest_there
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.material import leave_station
from opsim.engine.simpy_engine.state import Job, Station
from opsim.engine.simpy_engine.station import arrive
from opsim.engine.simpy_engine.vehicles import (
    BRINGING,
    COMING,
    FREE,
    GOING_HOME,
    LOADING,
    UNLOADING,
    Call,
    Pool,
    Vehicle,
    log_vehicle,
    now_does,
)
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import HELD, PICKUP, QUEUE, TRANSPORT

STEP_DONE = "vehicle is done"


def install(floor: Floor) -> None:
    """Vehicles stand at their places, and jobs of their legs call for them."""
    number, pools = 0, []
    for plan in floor.plan.transporters:
        pool = Pool(plan, {(leg.before, leg.after): leg for leg in plan.legs})
        pool.vehicles = [Vehicle(number + i, pool, plan.place, plan.place) for i in range(plan.n)]
        pool.n_free = plan.n
        number += plan.n
        pools.append(pool)
        for leg in pool.legs:
            floor.legs[leg] = _caller(pool)
    if pools:
        floor.dispatchers.append(partial(_dispatch, pools))
        floor.closing.append(partial(_close, pools))


def _caller(pool: Pool):
    def call(floor: Floor, job: Job, station: Station) -> None:
        """The job, whose place is sure, waits where it is; nobody has to stay with it."""
        floor.job_now(job, QUEUE if job.kind == QUEUE else HELD, PICKUP)
        if job.held_by is not None and floor.plan.when_blocked != "held":
            worker, job.held_by = job.held_by, None
            set_free(floor, worker)
        pool.take_call(job, station, floor.now)

    return call


def _dispatch(pools: list[Pool], floor: Floor) -> bool:
    """Vehicles that are ready do their next step, and free ones are sent; True where something was done."""
    changed = False
    for pool in pools:
        while pool.ready or (pool.calls and pool.n_free):
            ready, pool.ready = sorted(pool.ready, key=lambda vehicle: vehicle.number), []
            for vehicle in ready:
                _next_step(floor, vehicle)
            _send(floor, pool)
            changed = True
    return changed


def _send(floor: Floor, pool: Pool) -> None:
    free = [vehicle for vehicle in pool.vehicles if vehicle.doing == FREE]
    while free and pool.calls:
        call = pool.calls.pop(0)
        start = call.leg.place_from
        vehicle = min(free, key=lambda v: soonest_there(pool.plan.drive_s(v.place, start), v.number))
        free.remove(vehicle)
        vehicle.answers = call
        _drive(floor, vehicle, COMING, start)
    for vehicle in free:
        if pool.plan.goes_home and vehicle.place != pool.plan.place:
            _drive(floor, vehicle, GOING_HOME, pool.plan.place)


def _next_step(floor: Floor, vehicle: Vehicle) -> None:
    """What the vehicle does where it stands now: load, unload, drive on, or nothing."""
    doing = vehicle.doing
    if doing == GOING_HOME:
        _be_free(floor, vehicle)
        return
    if doing in (COMING, LOADING) and (call := _next_call(vehicle)) is not None:
        vehicle.answers = call
        _spend(floor, vehicle, LOADING, vehicle.place, vehicle.pool.plan.load_s)
        return
    if doing in (BRINGING, UNLOADING) and any(_goal(job) == vehicle.place for job in vehicle.aboard):
        _spend(floor, vehicle, UNLOADING, vehicle.place, vehicle.pool.plan.unload_s)
        return
    if vehicle.aboard:
        drive_s = vehicle.pool.plan.drive_s
        goals = {_goal(job) for job in vehicle.aboard}
        _drive(floor, vehicle, BRINGING, min(goals, key=lambda goal: nearest_stop(drive_s(vehicle.place, goal), goal)))
    else:
        _be_free(floor, vehicle)


def _next_call(vehicle: Vehicle) -> Call | None:
    """The call it came for, then what else waits here, as far as there is room."""
    if vehicle.answers is not None:
        return vehicle.answers
    pool = vehicle.pool
    return pool.next_call_at(vehicle.place) if len(vehicle.aboard) < pool.plan.capacity else None


def _drive(floor: Floor, vehicle: Vehicle, doing: int, place: int) -> None:
    _spend(floor, vehicle, doing, place, vehicle.pool.plan.drive_s(vehicle.place, place))


def _spend(floor: Floor, vehicle: Vehicle, doing: int, place: int, delay_s: float) -> None:
    """Do something from now on that takes some time, or none."""
    now_does(floor, vehicle, doing, place)
    if delay_s > 0:
        rank = len(floor.workers) + len(floor.stations) + vehicle.number
        floor.alarm(delay_s, COMPLETION, rank, 0, STEP_DONE, vehicle)
    else:
        _done(floor, vehicle)


def _done(floor: Floor, vehicle: Vehicle) -> None:
    """What the vehicle did is over; what it does next is decided when everybody has come to this instant."""
    if vehicle.doing == LOADING:
        _loaded(floor, vehicle)
    elif vehicle.doing == UNLOADING:
        _unloaded(floor, vehicle)
    vehicle.pool.ready.append(vehicle)


def _loaded(floor: Floor, vehicle: Vehicle) -> None:
    """The job is on the vehicle, and its station is rid of it."""
    call, vehicle.answers = vehicle.answers, None
    job: Job = call.job  # type: ignore[union-attr]
    floor.job_now(job, TRANSPORT)
    leave_station(floor, job)
    job.station = call.station  # type: ignore[union-attr]
    vehicle.aboard.append(job)


def _unloaded(floor: Floor, vehicle: Vehicle) -> None:
    """The first of the jobs that go here is at its station."""
    job = next(job for job in vehicle.aboard if _goal(job) == vehicle.place)
    vehicle.aboard.remove(job)
    floor.job_now(job, QUEUE)
    arrive(floor, job.station, job)


def _goal(job: Job) -> int:
    return job.station.place


def _be_free(floor: Floor, vehicle: Vehicle) -> None:
    now_does(floor, vehicle, FREE, vehicle.place)


def _close(pools: list[Pool], floor: Floor) -> None:
    for pool in pools:
        for vehicle in pool.vehicles:
            log_vehicle(floor, vehicle)


HANDLERS: dict[str, Handler] = {STEP_DONE: _done}
