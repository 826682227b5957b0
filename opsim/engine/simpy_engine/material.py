"""Jobs come in, move on, wait for room, and leave."""

from bisect import insort

from opsim.engine.rules import shortest_queue
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Gate, Job, Station
from opsim.engine.simpy_engine.station import seat
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import BLOCKED, CREATE, FINISH, FULL, GATE, HELD, LOST, QUEUE


def create(floor: Floor) -> Job:
    """The next job of the source, standing at the gate of its first station."""
    number = floor.n_released
    product = floor.draws.product(number)
    operation = floor.plan.products[product].route[0]
    job = Job(number, product, operation, floor.operation_rank[operation.name], HELD, GATE, floor.now)
    floor.n_released += 1
    floor.next_gate = None
    floor.jobs[number] = job
    floor.log_instant(CREATE, job)
    want_in(floor, job)
    return job


def want_in(floor: Floor, job: Job) -> None:
    """The job claims a place at its next operation."""
    gate = floor.gates[job.operation.stations]
    insort(gate.claims, (job.since_s, job.number, job))
    floor.stirred.add(gate)


def operation_done(floor: Floor, job: Job) -> None:
    """All tasks at a station are done: the job leaves the floor, or blocks the server until there is room for it."""
    route = floor.plan.products[job.product].route
    job.step += 1
    if job.step == len(route):
        _leave_station(floor, job)
        _leave_floor(floor, job, FINISH)
        return
    floor.job_now(job, BLOCKED)
    job.operation = route[job.step]
    want_in(floor, job)


def admit(floor: Floor) -> None:
    """Let jobs in as long as a claim meets room; the oldest claim first."""
    while floor.stirred and (gate := _first_gate_with_room(floor)) is not None:
        _since_s, _number, job = gate.claims.pop(0)
        _enter(floor, job, gate)


def release_saturated(floor: Floor) -> None:
    """A saturated source makes jobs as long as the first station of the next one has room."""
    while _next_has_room(floor):
        create(floor)
        admit(floor)


def turn_away(floor: Floor) -> None:
    """Jobs still outside are lost where the source does not wait."""
    for gate in floor.gates.values():
        lost = [claim for claim in gate.claims if claim[2].station is None]
        for claim in lost:
            gate.claims.remove(claim)
            _leave_floor(floor, claim[2], LOST, FULL)


def _first_gate_with_room(floor: Floor) -> Gate | None:
    best = None
    for gate in tuple(floor.stirred):
        if not gate.claims or not any(station.has_room for station in gate.stations):
            floor.stirred.discard(gate)
        elif best is None or gate.claims[0][:2] < best.claims[0][:2]:
            best = gate
    return best


def _next_has_room(floor: Floor) -> bool:
    gate = floor.next_gate
    if gate is None:
        product = floor.plan.products[floor.draws.product(floor.n_released)]
        gate = floor.next_gate = floor.gates[product.route[0].stations]
    return not gate.claims and any(station.has_room for station in gate.stations)


def _enter(floor: Floor, job: Job, gate: Gate) -> None:
    station = _chosen(gate)
    floor.job_now(job, QUEUE)
    if job.station is not None:
        _leave_station(floor, job)
    job.operation_rank = floor.operation_rank[job.operation.name]
    job.station = station
    station.n_inside += 1
    if station.free_servers:
        seat(floor, station, job)
    else:
        station.queue.append(job)


def _chosen(gate: Gate) -> Station:
    if len(gate.stations) == 1:
        return gate.stations[0]
    open_stations = [station for station in gate.stations if station.has_room]
    return min(open_stations, key=lambda s: shortest_queue(s.n_inside, s.plan.servers, s.rank))


def _leave_station(floor: Floor, job: Job) -> None:
    """The job gives its server back; whoever waits behind moves up, and whoever wants in may."""
    station: Station = job.station  # type: ignore[assignment]
    station.n_inside -= 1
    station.free_servers += 1
    if job.held_by is not None:
        worker, job.held_by = job.held_by, None
        set_free(floor, worker)
    if station.queue:
        seat(floor, station, station.queue.popleft())
    floor.stirred.update(station.wanted_by)


def _leave_floor(floor: Floor, job: Job, kind: int, cause: int = 0) -> None:
    floor.log_job(job)
    job.performance = None
    floor.log_instant(kind, job, cause)
    del floor.jobs[job.number]
