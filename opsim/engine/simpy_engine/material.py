"""Jobs come in, move on, wait for room, and leave."""

from bisect import insort

from opsim.engine.rules import shortest_queue
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Claim, Gate, Job, Station
from opsim.engine.simpy_engine.station import seat
from opsim.engine.simpy_engine.transport import bring
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import BLOCKED, CREATE, FINISH, FULL, GATE, HELD, LOST, QUEUE
from opsim.plan import Ways


def create(floor: Floor) -> Job:
    """The next job of the source, standing at the gate of its first station."""
    number = floor.n_released
    rank = floor.draws.product(number)
    product = floor.plan.products[rank]
    step = _first_step(floor, number)
    first = product.route[step]
    job = Job(number, rank, product, step, first, floor.operation_rank[first.name], HELD, GATE, floor.now)
    floor.n_released += 1
    floor.next_gate = None
    floor.jobs[number] = job
    floor.log_instant(CREATE, job)
    _want_in(floor, job)
    return job


def operation_done(floor: Floor, job: Job) -> None:
    """All tasks at a station are done: the job leaves the floor, or blocks the server until there is room for it."""
    step = _next_step(floor, job)
    if step < 0:
        _leave_station(floor, job)
        _leave_floor(floor, job, FINISH)
        return
    floor.job_now(job, BLOCKED)
    job.step, job.operation = step, job.plan.route[step]
    job.operation_rank = floor.operation_rank[job.operation.name]
    _want_in(floor, job)


def admit(floor: Floor) -> None:
    """Let jobs in as long as a claim meets room; the oldest claim first."""
    while floor.stirred and (found := _first_claim(floor)) is not None:
        claim, gate = found
        gate.claims.remove(claim)
        if not gate.claims:
            floor.stirred.discard(gate)
        _enter(floor, claim[2], gate)


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


def _want_in(floor: Floor, job: Job) -> None:
    """The job claims a place at its next operation."""
    gate = floor.gates[job.operation.stations]
    insort(gate.claims, (job.since_s, job.number, job))
    floor.stirred.add(gate)


def _next_step(floor: Floor, job: Job) -> int:
    """The step of the route that follows, -1 for the way out; drawn by job number and visit where there is a choice."""
    onward = job.plan.onward[job.step]
    if len(onward) == 1:
        return onward[0][1]
    visits = job.visits = {} if job.visits is None else job.visits
    visit = visits[job.step] = visits.get(job.step, -1) + 1
    return _taken(onward, floor.draws.way(job.operation.name, visit, job.number))


def _first_step(floor: Floor, number: int) -> int:
    """Where the job of this number begins, drawn where there is a choice."""
    start = floor.plan.products[floor.draws.product(number)].start
    return start[0][1] if len(start) == 1 else _taken(start, floor.draws.way("start", 0, number))


def _taken(ways: Ways, point: float) -> int:
    return next(step for cumulative, step in ways if point < cumulative)


def _first_claim(floor: Floor) -> tuple[Claim, Gate] | None:
    """The oldest claim that can be met among the gates where something changed; gates without one come to rest."""
    best: tuple[Claim, Gate] | None = None
    at_rest: list[Gate] = []
    for gate in floor.stirred:
        claim = gate.next_claim()
        if claim is None:
            at_rest.append(gate)
        elif best is None or claim < best[0]:
            best = claim, gate
    floor.stirred.difference_update(at_rest)
    return best


def _next_has_room(floor: Floor) -> bool:
    gate = floor.next_gate
    if gate is None:
        product = floor.plan.products[floor.draws.product(floor.n_released)]
        gate = floor.next_gate = floor.gates[product.route[_first_step(floor, floor.n_released)].stations]
    return not gate.claims and gate.has_room


def _enter(floor: Floor, job: Job, gate: Gate) -> None:
    if floor.now > job.since_s:
        floor.log_job(job)
    job.kind, job.cause, job.since_s = QUEUE, 0, floor.now
    station = gate.stations[0] if len(gate.stations) == 1 else _chosen(gate, job)
    carrier = None
    if job.station is not None:
        if job.plan.carried:
            carrier, job.held_by = job.held_by, None
        _leave_station(floor, job)
    job.station = station
    station.n_inside += 1
    bring(floor, job, station, carrier)


def _chosen(gate: Gate, job: Job) -> Station:
    with_room = [s for s in gate.stations if s.n_inside < s.capacity or s is job.station]
    return min(with_room, key=lambda s: shortest_queue(s.n_inside, s.plan.servers, s.rank))


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
    for gate in station.wanted_by:
        if gate.claims:
            floor.stirred.add(gate)


def _leave_floor(floor: Floor, job: Job, kind: int, cause: int = 0) -> None:
    floor.log_job(job)
    floor.log_instant(kind, job, cause)
    del floor.jobs[job.number]
