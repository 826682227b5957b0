"""Who comes in: claims that meet room, jobs that sources make where there is some, and those that are turned away."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, here, inlined, step
from opsim.engine.floor.material import create, depart_for, leave_floor
from opsim.engine.floor.parts.claims import is_before, take_claim
from opsim.engine.floor.parts.gates import be_still, has_room, keeps_place, next_claim
from opsim.engine.floor.parts.keys import begin_key, is_better, keep_best, put
from opsim.engine.floor.parts.records import Source
from opsim.engine.floor.parts.state import Floor, Gate, Job, Station
from opsim.engine.floor.parts.ways import first_step, product_of
from opsim.engine.floor.station import proceed
from opsim.engine.rules import release, routing
from opsim.log import FULL, LOST, NO_CARD

_shortest_queue, _source_in_turn = inlined(routing.shortest_queue), inlined(release.source_in_turn)


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
            return
        _create(floor, able)
        admit(floor)


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
