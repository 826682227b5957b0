"""Gates: who may come in, and who is looked at next."""

from __future__ import annotations

from opsim.engine.floor.machine import drop, inlined
from opsim.engine.floor.parts.claims import put_claim
from opsim.engine.floor.parts.events import stir_gate
from opsim.engine.floor.parts.state import Floor, Gate, Job
from opsim.log import AFTER


@inlined
def keeps_place(job: Job) -> bool:
    """Whether it needs no other place where it is: who is behind the servers, or shares one, would need one."""
    waits = True
    if job.ahead:
        waits = not job.ahead.station
    return waits and not job.seat and job.cause != AFTER


@inlined
def has_room(gate: Gate) -> bool:
    """A place at one of the stations."""
    for i in range(gate.n_stations):
        station = gate.stations[i]
        if station.n_inside < station.capacity:
            return True
    return False


@inlined
def leads_to(gate: Gate, job: Job) -> bool:
    """Whether the station where a job is is one of those behind the gate."""
    return job.station.rank >= 0 and gate.mask[job.station.rank] == 1


@inlined
def goes_in_next(floor: Floor, job: Job) -> bool:
    """Whether a claim of the job at its gate would be the first that is looked at, and met, and no block has a word."""
    gate, station = job.gate, job.station
    if gate.n_stations > 1 or gate.claims or floor.stirred or job.ahead or job.held_by:
        return False
    if gate.pick or gate.allows or gate.entered or floor.left_station:
        return False
    if station.clear or station.vacate or station.afters:
        return False
    return gate.stations[0].n_inside < gate.stations[0].capacity


@inlined
def is_allowed(floor: Floor, gate: Gate, job: Job) -> bool:
    """Whether no block keeps a job out."""
    for hook in gate.allows:
        if not hook.line(floor, hook.subject, job):
            return False
    return True


@inlined
def may_enter(floor: Floor, gate: Gate, job: Job) -> bool:
    """Whether there is room for a job, and nothing else keeps it out."""
    if job.ahead and job.ahead.station:
        return True
    room = has_room(gate) or (leads_to(gate, job) and keeps_place(job))
    return room and is_allowed(floor, gate, job)


@inlined
def first_that_may(floor: Floor, gate: Gate) -> int:
    """The number of the first claim that can be met; -1: none can."""
    for at in range(len(gate.claims)):
        if may_enter(floor, gate, gate.claims[at].job):
            return at
    return -1


@inlined
def next_claim(floor: Floor, gate: Gate) -> int:
    """The number of the claim that is met next; -1: none. A job that comes back to its station needs no other place."""
    if not gate.claims:
        return -1
    if gate.pick:
        return gate.pick.line(floor, gate.pick.subject, gate)
    if not gate.allows:
        if has_room(gate):
            return 0
        if not gate.comes_back:  # a long queue outside is not gone through again and again
            return -1
    return first_that_may(floor, gate)


@inlined
def be_still(floor: Floor, gate: Gate) -> None:
    """Nothing has changed for who wants in here."""
    gate.stirred = 0
    drop(floor.stirred, gate)


@inlined
def want_in(floor: Floor, job: Job, since_s: float) -> None:
    """The job claims a place at its next operation."""
    put_claim(floor, job.gate.claims, job, since_s)
    stir_gate(floor, job.gate)
