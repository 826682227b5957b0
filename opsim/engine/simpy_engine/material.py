"""Jobs come in, move on, wait for room, and leave."""

from bisect import insort

from opsim.engine.rules import shortest_queue, source_in_turn
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import OUTSIDE, Ahead, Claim, Gate, Job, Source, Station, claim_of
from opsim.engine.simpy_engine.station import fill_servers, proceed, seat
from opsim.engine.simpy_engine.transport import bring
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import BAD, BLOCKED, CREATE, FINISH, FULL, GATE, HELD, LOST, NO_CARD, QUEUE
from opsim.plan import ProductPlan, Ways


def create(floor: Floor, source: Source) -> Job:
    """The next job of a source, standing at the gate of its first station."""
    job = new_job(floor, source, source.product(source.n_released))
    source.next_gate = None
    gate = job.gate  # NOTE: ``want_in`` written out, once for each job
    insort(gate.claims, (-job.priority, floor.now, job.number, job))
    floor.stirred.add(gate)
    return job


def new_job(floor: Floor, source: Source, rank: int, n: int | None = None, station: int = -1, other: int = -1) -> Job:
    """The next job of a source (or its n-th), of the product of a rank: on the floor, and nowhere yet.

    station, other : where it comes into being, and of which job, where that is worth knowing
    """
    n = source.n_released if n is None else n
    product = floor.plan.products[rank]
    start = product.start
    step = start[0][1] if len(start) == 1 else _first_step(floor, source.rank, n, product)
    number = n * len(floor.sources) + source.rank
    job = Job(number, rank, product, step, *floor.steps[rank][step], HELD, GATE, floor.now, source.rank, n)
    job.lot, job.priority, job.due_s = product.lot, product.priority, floor.now + product.due_s
    source.n_released = n + 1
    floor.jobs[number] = job
    if station < 0 and other < 0:
        floor.log_instant(CREATE, job)
    else:
        floor.log_instant(CREATE, job, 0, station, other)
    if floor.created:
        for told in floor.created:
            told(floor, job)
    return job


def operation_done(floor: Floor, job: Job) -> None:
    """All tasks at a station are done: the job leaves the floor, or blocks the server until there is room for it."""
    station = job.station
    if station.meter is not None:
        station.meter.cycle(floor)
    if station.after:
        ask_after(floor, job)
    elif job.ahead is not None:
        move_on(floor, job)
    else:  # NOTE: ``move_on`` written out, once for each operation
        onward = job.plan.onward[job.step]
        go_to(floor, job, onward[0][1] if len(onward) == 1 else next_step(floor, job))


def ask_after(floor: Floor, job: Job) -> None:
    """What is asked when an operation is done; where nothing else becomes of it, the job moves on."""
    for hook in job.station.after:
        if not hook(floor, job):
            return
    move_on(floor, job)


def move_on(floor: Floor, job: Job) -> None:
    """The job wants to go where its way leads, or is finished."""
    if job.ahead is not None:
        go_to(floor, job, job.ahead.step)
        return
    onward = job.plan.onward[job.step]
    go_to(floor, job, onward[0][1] if len(onward) == 1 else next_step(floor, job))


def go_to(floor: Floor, job: Job, step: int) -> None:
    """The job wants to go to a step of its route; -1: out."""
    if step < 0:
        leave_station(floor, job)
        leave_floor(floor, job, FINISH, BAD if job.bad else 0)
        return
    now = floor.now
    if now > job.since_s:
        floor.log_job(job)
    job.kind, job.cause, job.since_s = BLOCKED, 0, now
    job.step = step
    job.operation, job.operation_rank, gate = floor.steps[job.product][step]
    job.gate = gate
    insort(gate.claims, (-job.priority, now, job.number, job))
    floor.stirred.add(gate)
    station = job.station
    if station.clear is not None:
        station.clear(floor, station, job)


def aim(floor: Floor, job: Job, step: int) -> None:
    """The job's next operation is that of a step of its route."""
    job.step = step
    job.operation, job.operation_rank, job.gate = floor.steps[job.product][step]


def next_step(floor: Floor, job: Job) -> int:
    """The step of the route that follows, -1 for the way out; drawn by job number and visit where there is a choice."""
    onward = job.plan.onward[job.step]
    if len(onward) == 1:
        return onward[0][1]
    visits = job.visits = {} if job.visits is None else job.visits
    visit = visits[job.step] = visits.get(job.step, -1) + 1
    return _taken(onward, floor.draws.way(job.operation.name, visit, job.source, job.n))


def want_place(floor: Floor, job: Job, step: int) -> None:
    """The job, still at its station, claims a place at a step to come; ``proceed`` is called when it has one."""
    ahead = job.ahead = Ahead(step, floor.steps[job.product][step][2])
    insort(ahead.gate.claims, claim_of(job, floor.now))
    floor.stirred.add(ahead.gate)


def admit(floor: Floor) -> None:
    """Let jobs in as long as a claim meets room; the oldest claim first."""
    while floor.stirred and (found := _first_claim(floor)) is not None:
        claim, gate = found
        claims, job = gate.claims, claim[3]
        claims.remove(claim)
        if not claims:
            floor.stirred.discard(gate)
        if job.ahead is None:
            _enter(floor, job, gate)
        elif job.ahead.station is None:
            _keep_place(floor, job, gate)
        else:
            kept, own, job.ahead = job.ahead.station, job.ahead.own, None
            if own:  # it was never counted twice
                kept.n_inside += 1
            depart_for(floor, job, kept)


def release_saturated(floor: Floor) -> None:
    """A saturated source makes jobs as long as the first station of the next one has room; of several in turn."""
    if len(floor.saturated) == 1:
        (only,) = floor.saturated
        while _next_has_room(floor, only):
            create(floor, only)
            admit(floor)
        return
    while able := [source for source in floor.saturated if _next_has_room(floor, source)]:
        create(floor, min(able, key=lambda source: source_in_turn(source.n_released, source.rank)))
        admit(floor)


def turn_away(floor: Floor) -> None:
    """Jobs still outside are lost where their source does not wait."""
    for gate in floor.gates.values():
        lost = [claim for claim in gate.claims if claim[3].station is OUTSIDE and claim[3].source in floor.losing]
        for claim in lost:
            gate.claims.remove(claim)
            leave_floor(floor, claim[3], LOST, NO_CARD if claim[3].cause == NO_CARD else FULL)


def want_in(floor: Floor, job: Job) -> None:
    """The job claims a place at its next operation."""
    gate = job.gate
    insort(gate.claims, (-job.priority, job.since_s, job.number, job))
    floor.stirred.add(gate)


def withdraw(floor: Floor, job: Job) -> None:
    """The job no longer claims a place at its next operation, and gives back the one it may have."""
    gate = job.gate if job.ahead is None else job.ahead.gate
    gate.claims = [claim for claim in gate.claims if claim[3] is not job]
    if job.ahead is not None:
        give_up_place(floor, job, job.ahead)
    job.ahead = None


def give_up_place(floor: Floor, job: Job, ahead: Ahead) -> None:
    """The job gives back the place that is kept for it, with the cards that were taken for it."""
    kept, ahead.station = ahead.station, None
    if kept is None:
        return
    if ahead.gate.given_up is not None:
        ahead.gate.given_up(floor, job)
    if not ahead.own:
        kept.n_inside -= 1
        floor.stir(kept)
    ahead.own = False


def _first_step(floor: Floor, source: int, n: int, product: ProductPlan) -> int:
    """Where the n-th job of a source begins, drawn where there is a choice."""
    start = product.start
    return start[0][1] if len(start) == 1 else _taken(start, floor.draws.way("start", 0, source, n))


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


def _next_has_room(floor: Floor, source: Source) -> bool:
    gate = source.next_gate
    if gate is None:
        rank = source.product(source.n_released)
        step = _first_step(floor, source.rank, source.n_released, floor.plan.products[rank])
        gate = source.next_gate = floor.steps[rank][step][2]
        source.next_want = rank, step
    if gate.lets is not None:
        return gate.has_room and gate.lets(*source.next_want)
    return not gate.claims and gate.has_room


def _enter(floor: Floor, job: Job, gate: Gate) -> None:
    """There is room for the job: the place is its own from now on."""
    stations = gate.stations
    station = stations[0] if len(stations) == 1 else _chosen(gate, job)
    station.n_inside += 1
    if gate.entered is not None:
        gate.entered(floor, job)
    depart_for(floor, job, station)


def _keep_place(floor: Floor, job: Job, gate: Gate) -> None:
    """The place is kept for the job, which stays where it is and goes on there."""
    ahead: Ahead = job.ahead  # type: ignore[assignment]
    station = gate.stations[0] if len(gate.stations) == 1 else _chosen(gate, job)
    ahead.own = station is job.station and job.keeps_place
    ahead.station = station
    station.n_inside += not ahead.own
    if gate.entered is not None:
        gate.entered(floor, job)
    proceed(floor, job)


def depart_for(floor: Floor, job: Job, station: Station) -> None:
    """The job, whose place at a station is sure, leaves where it is; or waits for who is to fetch it."""
    before = job.station
    if floor.legs and before is not OUTSIDE and (leg := floor.legs.get((before.rank, station.rank))) is not None:
        leg(floor, job, station)
        return
    if floor.now > job.since_s:
        floor.log_job(job)
    job.kind, job.cause, job.since_s = QUEUE, 0, floor.now
    carrier = None
    if before is not OUTSIDE:
        if job.plan.carried:
            carrier, job.held_by = job.held_by, None
        leave_station(floor, job)
    job.station = station
    bring(floor, job, station, carrier)


def _chosen(gate: Gate, job: Job) -> Station:
    with_room = [s for s in gate.stations if s.n_inside < s.capacity or (s is job.station and job.keeps_place)]
    if gate.choose is not None:
        return gate.choose(with_room, job)
    return min(with_room, key=lambda s: shortest_queue(s.n_inside, s.plan.servers, s.rank))


def leave_station(floor: Floor, job: Job) -> None:
    """The job gives its place back; whoever waits behind moves up, and whoever wants in may."""
    station = job.station
    station.n_inside -= 1
    if job.held_by is not None:
        worker, job.held_by = job.held_by, None
        set_free(floor, worker)
    if floor.left_station:
        for told in floor.left_station:
            told(floor, job, station)
    if station.vacate is not None:
        station.vacate(floor, station, job)
    elif job.seat is not None or station.seated is not None:
        leave_server(floor, station, job)
    else:  # NOTE: leave_server written out, once for each operation
        station.free_servers += 1
        if not station.queue:
            pass
        elif station.serve is None and station.order is None:
            seat(floor, station, station.queue.popleft())
        else:
            fill_servers(floor, station)
    for gate in station.wanted_by:
        if gate.claims:
            floor.stirred.add(gate)


def leave_server(floor: Floor, station: Station, job: Job) -> None:
    """The job gives its server back, where it is the last one on it; whoever is next in the queue moves up."""
    if station.seated is not None:
        station.seated.remove(job)
    if job.seat is not None:
        seat, job.seat = job.seat, None
        seat.n_jobs -= 1
        if seat.n_jobs or station.serve is not None:  # the room that was made for it goes with it
            station.capacity -= 1
        if seat.n_jobs:
            return
    station.free_servers += 1
    if station.queue:
        fill_servers(floor, station)


def leave_floor(floor: Floor, job: Job, kind: int, cause: int = 0, station: int = -1, other: int = -1) -> None:
    """The job is on the floor no more, in the way that ``kind`` says; where, and for which other job, where that is
    worth knowing.
    """
    floor.log_job(job)
    floor.log_instant(kind, job, cause, station, other)
    del floor.jobs[job.number]
    if floor.left_floor:
        for told in floor.left_floor:
            told(floor, job)
