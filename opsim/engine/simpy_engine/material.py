"""Jobs come in, move on, wait for room, and leave."""

from bisect import insort

from opsim.engine.rules import shortest_queue
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Claim, Gate, Job, Station
from opsim.engine.simpy_engine.station import seat
from opsim.engine.simpy_engine.transport import bring
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import BLOCKED, CREATE, FINISH, FULL, GATE, HELD, LOST, QUEUE
from opsim.plan import ProductPlan, Ways


def create(floor: Floor) -> Job:
    """The next job of the source, standing at the gate of its first station."""
    number = floor.n_released
    rank = floor.draws.product(number)
    product = floor.plan.products[rank]
    step = _first_step(floor, number, product)
    job = Job(number, rank, product, step, *floor.steps[rank][step], HELD, GATE, floor.now)
    floor.n_released += 1
    floor.next_gate = None
    floor.jobs[number] = job
    floor.log_instant(CREATE, job)
    _want_in(floor, job)
    return job


def operation_done(floor: Floor, job: Job) -> None:
    """All tasks at a station are done: the job leaves the floor, or blocks the server until there is room for it."""
    onward = job.plan.onward[job.step]
    step = onward[0][1] if len(onward) == 1 else _drawn_step(floor, job, onward)
    if step < 0:
        _leave_station(floor, job)
        _leave_floor(floor, job, FINISH)
        return
    floor.job_now(job, BLOCKED)
    job.step = step
    job.operation, job.operation_rank, job.gate = floor.steps[job.product][step]
    _want_in(floor, job)


def admit(floor: Floor) -> None:
    """Let jobs in as long as a claim meets room; the oldest claim first."""
    while floor.stirred and (found := _first_claim(floor)) is not None:
        claim, gate = found
        claims = gate.claims
        claims.remove(claim)
        if not claims:
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
    gate = job.gate
    insort(gate.claims, (job.since_s, job.number, job))
    floor.stirred.add(gate)


def _drawn_step(floor: Floor, job: Job, onward: Ways) -> int:
    """The step of the route that follows, -1 for the way out; drawn by job number and visit where there is a choice."""
    visits = job.visits = {} if job.visits is None else job.visits
    visit = visits[job.step] = visits.get(job.step, -1) + 1
    return _taken(onward, floor.draws.way(job.operation.name, visit, job.number))


def _first_step(floor: Floor, number: int, product: ProductPlan) -> int:
    """Where the job of this number begins, drawn where there is a choice."""
    start = product.start
    return start[0][1] if len(start) == 1 else _taken(start, floor.draws.way("start", 0, number))


def _taken(ways: Ways, point: float) -> int:
    return next(step for cumulative, step in ways if point < cumulative)


def _first_claim(floor: Floor) -> tuple[Claim, Gate] | None:
    """The oldest claim that can be met among the gates where something changed; gates without one come to rest."""
    if len(floor.stirred) == 1:  # NOTE: most often
        (only,) = floor.stirred
        claim = only.next_claim()
        if claim is not None:
            return claim, only
        floor.stirred.clear()
        return None
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
        rank = floor.draws.product(floor.n_released)
        step = _first_step(floor, floor.n_released, floor.plan.products[rank])
        gate = floor.next_gate = floor.steps[rank][step][2]
    return not gate.claims and gate.has_room


def _enter(floor: Floor, job: Job, gate: Gate) -> None:
    now, stations = floor.now, gate.stations
    if now > job.since_s:
        floor.log_job(job)
    job.kind, job.cause, job.since_s = QUEUE, 0, now
    station = stations[0] if len(stations) == 1 else _chosen(gate, job)
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
