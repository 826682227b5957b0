"""Who comes in: claims that meet room, jobs that sources make where there is some, and those that are turned away.

Places downstream and behind: blocking before service, and buffers for finished jobs.
"""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.floor_state import Floor, Source
from opsim.engine.floor.flow import create, depart_for, leave_floor, leave_server, want_place
from opsim.engine.floor.keys import begin_key, is_better, keep_best, put
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import NOTHING, drop, fresh, here, inlined, step
from opsim.engine.floor.state import Ahead, Gate, Job, Station
from opsim.log import AFTER, BLOCKED, FULL, HELD, LOST, NO_CARD, NO_PLACE, PICKUP, QUEUE
from opsim.subjects.people.worker import set_free
from opsim.subjects.routes.routing import (
    be_still,
    first_step,
    has_room,
    is_before,
    keeps_place,
    leads_to,
    next_claim,
    product_of,
    step_after,
    stir,
    take_claim,
)
from opsim.subjects.stations.station import proceed

_shortest_queue, _source_in_turn = inlined(rules.shortest_queue), inlined(rules.source_in_turn)


@step
def admit(floor: Floor) -> None:
    """Let jobs in as long as a claim meets room; the oldest claim first."""
    while floor.stirred:
        gate = _first_gate(floor)
        if not gate:
            return
        job = gate.claims[gate.next].job
        take_claim(floor, gate.claims, gate.next)
        if not gate.claims:
            be_still(floor, gate)
        if not job.ahead:
            _come_in(floor, job, gate)
        elif not job.ahead.station:
            _keep_place(floor, job, gate)
        else:
            kept, own = job.ahead.station, job.ahead.own
            job.ahead = NOTHING
            if own:  # it was never counted twice
                kept.n_inside += 1
            depart_for(floor, job, kept)


@step
def first_gate(floor: Floor) -> Gate:
    """Where the oldest claim is that can be met, its number in ``next``; gates without one come to rest."""
    best: Gate = floor.no_gate
    at = 0
    while at < len(floor.stirred):
        gate = floor.stirred[at]
        gate.next = next_claim(floor, gate)
        if gate.next < 0:
            be_still(floor, gate)
            continue
        if not best or is_before(gate.claims[gate.next], best.claims[best.next]):
            best = gate
        at += 1
    return best


@inlined
def _comes_first(one: Source, other: Source) -> bool:
    return _source_in_turn(one.n_released, one.rank) < _source_in_turn(other.n_released, other.rank)


@step
def release_saturated(floor: Floor) -> None:
    """A saturated source makes jobs as long as the first station of the next one has room; of several in turn."""
    while True:
        able: Source = floor.no_source
        for source in floor.saturated:
            if _has_next(floor, source) and (not able or _comes_first(source, able)):
                able = source
        if not able:
            floor.entries_full = 1 if _entries_are_full(floor) else 0
            return
        _create(floor, able)
        admit(floor)


@step
def _entries_are_full(floor: Floor) -> bool:
    """Whether no saturated source need be asked until one of the stations that it is kept from has room again."""
    for source in floor.saturated:
        gate = source.next_gate
        if gate.lets or has_room(gate):
            return False
        for i in range(gate.n_stations):
            gate.stations[i].is_entry = 1
    return True


@step
def _next_has_room(floor: Floor, source: Source) -> bool:
    gate = source.next_gate
    if not gate:
        source.next_product = product_of(floor, source, source.n_released)
        product = floor.products[source.next_product]
        source.next_step = first_step(floor, source.rank, source.n_released, product)
        gate = product.steps[source.next_step].gate
        source.next_gate = gate
    if gate.lets:
        floor.asked_k = source.next_step
        return has_room(gate) and gate.lets.line(floor, gate.lets.subject, gate, source) != 0
    return len(gate.claims) == 0 and has_room(gate)


@step
def turn_away(floor: Floor) -> None:
    """Jobs still outside are lost where their source does not wait."""
    for i in range(floor.n_gates):
        gate = floor.gates[i]
        at = 0
        while at < len(gate.claims):
            job = gate.claims[at].job
            if job.station.rank < 0 and floor.sources[job.source].loses:
                take_claim(floor, gate.claims, at)
                leave_floor(floor, job, LOST, NO_CARD if job.cause == NO_CARD else FULL, -1, -1)
            else:
                at += 1


@inlined
def _told_entered(floor: Floor, gate: Gate, job: Job) -> None:
    for hook in gate.entered:
        hook.line(floor, hook.subject, job)


@step
def _enter(floor: Floor, job: Job, gate: Gate) -> None:
    """There is room for the job: the place is its own from now on."""
    station = gate.stations[0] if gate.n_stations == 1 else _chosen(floor, gate, job)
    station.n_inside += 1
    _told_entered(floor, gate, job)
    _depart_for(floor, job, station)


@step
def _keep_place(floor: Floor, job: Job, gate: Gate) -> None:
    """The place is kept for the job, which stays where it is and goes on there."""
    ahead = job.ahead
    station = gate.stations[0] if gate.n_stations == 1 else _chosen(floor, gate, job)
    ahead.own = station is job.station and keeps_place(job)
    ahead.station = station
    if not ahead.own:
        station.n_inside += 1
    _told_entered(floor, gate, job)
    proceed(floor, job, NOTHING)


@step
def _chosen(floor: Floor, gate: Gate, job: Job) -> Station:
    """Which of several stations with room a job takes: by the gate's own rule, or where fewest jobs a server are."""
    found = gate.stations[0]
    is_first = True
    for i in range(gate.n_stations):
        station = gate.stations[i]
        if station.n_inside < station.capacity or (station is job.station and keeps_place(job)):
            begin_key(floor)
            if gate.choose:
                _ = gate.choose.line(floor, gate.choose.subject, station, job)
            else:
                key = _shortest_queue(float(station.n_inside), float(station.servers), float(station.rank))
                put(floor, key[0])
                put(floor, key[1])
            if is_first or is_better(floor):
                found, is_first = station, False
                keep_best(floor)
    return found


_first_gate, _come_in, _depart_for = here(first_gate), here(_enter), here(depart_for)
_create, _has_next = here(create), here(_next_has_room)
PLACE_COMES = 10
"""The place of this among the preparations of a job."""
_new_ahead = fresh(Ahead)


def install(build: Any) -> None:
    """Stations that ask for a place downstream first, and those with a buffer behind."""
    for station, plan in zip(build.stations, build.plan.stations):
        if plan.place_first:
            build.hang(station.stages, has_place, None, PLACE_COMES)
        if plan.buffer_after:
            build.seat(station)
            station.clear, station.vacate = build.hook(put_away), build.hook(vacate)


@step
def has_place(floor: Floor, subject: Any, job: Job) -> bool:
    """Claim a place at the next operation; True where it is kept, or none is needed."""
    ahead = job.ahead
    if ahead and (ahead.step < 0 or ahead.station):
        return True
    step = ahead.step if ahead else step_after(floor, job)  # who lost his server may have lost his place too
    gate = job.plan.steps[step].gate if step >= 0 else job.gate
    stays = step >= 0 and _may_stay(gate, job)
    if step < 0 or stays:
        _need_none(floor, job, step, gate, stays)
        return True
    job_now(floor, job, HELD, NO_PLACE)
    want_place(floor, job, step)
    return False


@inlined
def _may_stay(gate: Gate, job: Job) -> bool:
    """Whether its place here is one of those that it wants, and nothing else is asked for them."""
    return leads_to(gate, job) and keeps_place(job) and len(gate.allows) == 0 and not gate.pick


@inlined
def _need_none(floor: Floor, job: Job, step: int, gate: Gate, stays: bool) -> None:
    """The job needs no other place than it has."""
    ahead: Ahead = _new_ahead(floor)
    ahead.step, ahead.gate = step, gate
    if stays:
        ahead.station, ahead.own = job.station, 1
    job.ahead = ahead


@step
def put_away(floor: Floor, station: Station, job: Job) -> None:
    """A finished job that has to go on clears its server, where there is room behind."""
    if len(station.put_away) < station.buffer_after and not _stays(job):
        clear_server(floor, station, job)


@inlined
def _stays(job: Job) -> bool:
    """Whether the job's next operation is at the station where it is, and its place there the one it has."""
    if job.ahead:
        return job.ahead.own == 1
    return False


@step
def clear_server(floor: Floor, station: Station, job: Job) -> None:
    """The job leaves its server for the buffer behind: its place at the station does not count any more."""
    job_now(floor, job, QUEUE, PICKUP if job.cause == PICKUP else AFTER)
    station.put_away.append(job)
    station.capacity += 1
    floor.entries_full = 0
    if job.held_by and not job.plan.carried:
        worker = job.held_by
        job.held_by = NOTHING
        set_free(floor, worker)
    leave_server(floor, station, job)
    stir(floor, station)


@step
def vacate(floor: Floor, station: Station, job: Job) -> None:
    """A job goes on: from its server, or from the buffer behind, where the oldest that is done follows."""
    if job not in station.put_away:
        leave_server(floor, station, job)
        return
    drop(station.put_away, job)
    station.capacity -= 1
    oldest: Job = floor.handed_over
    found = False
    for one in station.seated:
        if _is_done(one) and not _stays(one) and (not found or _is_older(one, oldest)):
            oldest, found = one, True
    if found:
        clear_server(floor, station, oldest)


@inlined
def _is_done(job: Job) -> bool:
    """Whether a job on a server waits for room downstream, or for a vehicle."""
    return job.kind == BLOCKED or (job.kind == HELD and job.cause == PICKUP)


@inlined
def _is_older(one: Job, other: Job) -> bool:
    if one.since_s != other.since_s:
        return one.since_s < other.since_s
    return one.number < other.number
