"""Jobs between stations: carried by the worker who did the last task.

Jobs come in, move on, wait for room, and leave.
"""

from __future__ import annotations

from opsim.engine import rules
from opsim.engine.floor.floor_state import Floor, Source
from opsim.engine.floor.log_rows import job_now, log_instant, log_job, log_worker
from opsim.engine.floor.machine import (
    NOTHING,
    drop,
    fresh,
    give_back,
    give_ints_back,
    give_items_back,
    here,
    inlined,
    step,
)
from opsim.engine.floor.state import Ahead, Job, JobBlocks, Station, Worker
from opsim.log import BAD, BLOCKED, CREATE, FINISH, GATE, HELD, QUEUE, TRANSPORT
from opsim.subjects.people.worker import set_free, walk
from opsim.subjects.routes.routing import (
    aim,
    first_step,
    give_up_claims,
    goes_in_next,
    product_of,
    put_claim,
    step_after,
    stir,
    stir_gate,
    want_in,
)
from opsim.subjects.stations.station import arrive, fill_servers, seat

_walks_to_carry = inlined(rules.walks_to_carry)


@step
def bring(floor: Floor, job: Job, station: Station, carrier: Worker) -> None:
    """The job has its place at the next station and comes there: carried, or at once where nobody carries it."""
    walk_s = carrier.walk_s[carrier.place * floor.n_stations + station.rank] if carrier else 0.0
    if not carrier or walk_s == 0:
        if carrier:
            carrier.place = station.place
            _stand_at(carrier, station)
            set_free(floor, carrier)
        _arrive(floor, station, job)
        return
    log_worker(floor, carrier)
    job.kind = TRANSPORT
    carrier.station = station
    mass_kg, most_kg = job.plan.mass_kg, carrier.most_load_kg
    carrier.walks_left = 0
    if mass_kg > 0 and most_kg > 0:
        carrier.walks_left = int(_walks_to_carry(job.lot, mass_kg, most_kg)) - 1
    walk(floor, carrier, station.place, walk_s)


@step
def put_down(floor: Floor, job: Job, carrier: Worker) -> None:
    """The carrier has come to the station with the job and is free there, if he need not go again for the rest."""
    if carrier.walks_left:
        _go_again(floor, carrier)
        return
    job_now(floor, job, QUEUE, 0)
    _stand_at(carrier, job.station)
    set_free(floor, carrier)
    arrive(floor, job.station, job)


@inlined
def _go_again(floor: Floor, carrier: Worker) -> None:
    """A part of the lot is there, or he is back where the rest of it lies: he walks the other way."""
    carrier.walks_left -= 1
    log_worker(floor, carrier)
    goal = carrier.walk_from
    walk(floor, carrier, goal, floor.distance_m[carrier.place * floor.n_places + goal] / carrier.walk_m_per_s)


@inlined
def _stand_at(carrier: Worker, station: Station) -> None:
    """Where the station is on his round, he goes on from it; elsewhere he serves nobody and walks to his next stop."""
    for i in range(carrier.n_patrol):
        if carrier.patrol[i] == station.rank:
            carrier.round = i
            return


_arrive = here(arrive)


_new_job, _forget_job, _new_ahead = fresh(Job), give_back(Job), fresh(Ahead)
_new_blocks = fresh(JobBlocks)


@step
def create(floor: Floor, source: Source) -> Job:
    """The next job of a source, standing at the gate of its first station."""
    job = _makes(floor, source, product_of(floor, source, source.n_released), -1, -1, -1)
    source.next_gate = NOTHING
    want_in(floor, job, floor.now)
    return job


@step
def new_job(floor: Floor, source: Source, rank: int, n: int, station: int, other: int) -> Job:
    """The next job of a source (n: -1, or its n-th), of the product of a rank: on the floor, and nowhere yet.

    station, other : where it comes into being, and of which job, where that is worth knowing; else -1
    """
    if n < 0:
        n = source.n_released
    product = floor.products[rank]
    job: Job = _new_job(floor)
    job.number, job.n, job.source = n * floor.n_sources + source.rank, n, source.rank
    job.product, job.plan = rank, product
    aim(job, first_step(floor, source.rank, n, product))
    job.kind, job.cause, job.since_s = HELD, GATE, floor.now
    job.station = floor.outside
    job.worker = job.task = job.performance_id = job.k = job.setup_task = -1
    job.lot, job.priority, job.due_s = product.lot, product.priority, floor.now + product.due_s
    if floor.has_job_blocks:
        job.block = _new_blocks(floor)
    source.n_released = n + 1
    _join_floor(floor, job)
    log_instant(floor, CREATE, job, 0, station, other)
    for hook in floor.created:
        hook.line(floor, hook.subject, job)
    return job


@inlined
def _join_floor(floor: Floor, job: Job) -> None:
    """The job is the last that has come."""
    job.on_floor = 1
    last = floor.last_job
    job.before_on_floor = last
    if last:
        last.next_on_floor = job
    else:
        floor.first_job = job
    floor.last_job = job
    floor.n_jobs += 1


@inlined
def _part_with_floor(floor: Floor, job: Job) -> None:
    job.on_floor = 0
    if floor.done is job:
        floor.done = NOTHING
    before, after = job.before_on_floor, job.next_on_floor
    if before:
        before.next_on_floor = after
    else:
        floor.first_job = after
    if after:
        after.before_on_floor = before
    else:
        floor.last_job = before
    floor.n_jobs -= 1


@step
def operation_done(floor: Floor, job: Job) -> None:
    """All tasks at a station are done: the job leaves the floor, or blocks the server until there is room for it."""
    station = job.station
    if station.meter:
        station.meter.cycle_line(floor, station.meter)
    _ask_after(floor, job)


@step
def ask_after(floor: Floor, job: Job) -> None:
    """What is asked when an operation is done; where nothing else becomes of it, the job moves on."""
    station = job.station
    for after in station.afters:
        if not after.line(floor, after.subject, job):
            return
    _move_on(floor, job)


@step
def move_on(floor: Floor, job: Job) -> None:
    """The job wants to go where its way leads, or is finished."""
    _go_to(floor, job, job.ahead.step if job.ahead else step_after(floor, job))


@step
def go_to(floor: Floor, job: Job, step: int) -> None:
    """The job wants to go to a step of its route; -1: out."""
    if step < 0:
        _leave_station(floor, job)
        _leave_floor(floor, job, FINISH, BAD if job.bad else 0, -1, -1)
        return
    job_now(floor, job, BLOCKED, 0)
    aim(job, step)
    if floor.at_once and goes_in_next(floor, job):
        _go_in(floor, job, job.gate.stations[0])
        return
    want_in(floor, job, floor.now)
    station = job.station
    if station.clear:
        station.clear.line(floor, station, job)


@inlined
def _go_in(floor: Floor, job: Job, station: Station) -> None:
    """What becomes of a claim that is met, without putting it down; who moves up behind the job does not go so."""
    floor.at_once = 0
    station.n_inside += 1
    _depart_for(floor, job, station)


@step
def want_place(floor: Floor, job: Job, step: int) -> None:
    """The job, still at its station, claims a place at a step to come; ``proceed`` is called when it has one."""
    ahead: Ahead = _new_ahead(floor)
    ahead.step = step
    ahead.gate = job.plan.steps[step].gate
    job.ahead = ahead
    put_claim(floor, ahead.gate.claims, job, floor.now)
    stir_gate(floor, ahead.gate)


@step
def withdraw(floor: Floor, job: Job) -> None:
    """The job no longer claims a place at its next operation, and gives back the one it may have."""
    gate = job.ahead.gate if job.ahead else job.gate
    give_up_claims(floor, gate.claims, job)
    if job.ahead:
        give_up_place(floor, job, job.ahead)
    job.ahead = NOTHING


@step
def give_up_place(floor: Floor, job: Job, ahead: Ahead) -> None:
    """The job gives back the place that is kept for it, with the cards that were taken for it."""
    kept = ahead.station
    ahead.station = NOTHING
    if not kept:
        return
    if ahead.gate.given_up:
        ahead.gate.given_up.line(floor, ahead.gate.given_up.subject, job)
    if not ahead.own:
        kept.n_inside -= 1
        stir(floor, kept)
    ahead.own = 0


@step
def depart_for(floor: Floor, job: Job, station: Station) -> None:
    """The job, whose place at a station is sure, leaves where it is; or waits for who is to fetch it."""
    before = job.station
    if floor.has_legs and before.rank >= 0:
        leg = floor.legs[before.rank * floor.n_stations + station.rank]
        if leg:
            leg.line(floor, leg.subject, job, station)
            return
    job_now(floor, job, QUEUE, 0)
    carrier: Worker = floor.no_worker
    if before.rank >= 0:
        if job.plan.carried:
            carrier = job.held_by
            job.held_by = NOTHING
        leave_station(floor, job)
    job.station = station
    _bring(floor, job, station, carrier)


@inlined
def part_with_station(floor: Floor, job: Job) -> None:
    """Who stayed with the job is free, and who asks for it is told that it has left its station."""
    if job.held_by:
        worker = job.held_by
        job.held_by = NOTHING
        set_free(floor, worker)
    for told in floor.left_station:
        told.line(floor, told.subject, job, job.station)


@step
def leave_station(floor: Floor, job: Job) -> None:
    """The job gives its place back; whoever waits behind moves up, and whoever wants in may."""
    station = job.station
    station.n_inside -= 1
    part_with_station(floor, job)
    if station.vacate:
        station.vacate.line(floor, station, job)
    elif job.seat or station.has_seated:
        leave_server(floor, station, job)
    else:
        station.free_servers += 1
        if station.serve or station.order:
            if station.queue:
                fill_servers(floor, station)
        elif station.queue:
            _seat(floor, station, station.queue.pop(0))
    stir(floor, station)


@step
def leave_server(floor: Floor, station: Station, job: Job) -> None:
    """The job gives its server back, where it is the last one on it; whoever is next in the queue moves up."""
    if station.has_seated:
        be_unseated(floor, station, job)
    seat = job.seat
    if seat:
        job.seat = NOTHING
        seat.n_jobs -= 1
        if seat.n_jobs or station.serve:  # the room that was made for it goes with it
            station.capacity -= 1
        if seat.n_jobs:
            return
    station.free_servers += 1
    if station.queue:
        fill_servers(floor, station)


@step
def be_unseated(floor: Floor, station: Station, job: Job) -> None:
    """The job leaves its server, which others may share (``Servers.remove``)."""
    drop(station.seated, job)
    if station.setups:
        station.setups.leaves_line(floor, station, job)


@step
def leave_floor(floor: Floor, job: Job, kind: int, cause: int, station: int, other: int) -> None:
    """The job is on the floor no more, in the way that ``kind`` says; where, and for which other job, or -1."""
    log_job(floor, job)
    log_instant(floor, kind, job, cause, station, other)
    _part_with_floor(floor, job)
    for hook in floor.left_floor:
        hook.line(floor, hook.subject, job)
    if not floor.keeps_jobs:
        _forgets(floor, job)


@step
def forget_job(floor: Floor, job: Job) -> None:
    """Nobody refers to the job any more: its memory is free."""
    if job.visits:
        give_ints_back(floor, job.visits, job.plan.n_steps)
    give_items_back(floor, job.passes)
    give_items_back(floor, job.reworks)
    _forget_job(floor, job)


_ask_after, _move_on, _go_to, _bring = here(ask_after), here(move_on), here(go_to), here(bring)
_makes, _forgets, _leave_floor, _leave_station = here(new_job), here(forget_job), here(leave_floor), here(leave_station)
_seat, _depart_for = here(seat), here(depart_for)
