"""Where jobs go on, and what they wait for: ways of a route, claims in the order in which they are met, and gates."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.event_list import new_event, on_grid, push_event
from opsim.engine.floor.floor_state import Floor, Source
from opsim.engine.floor.machine import NOTHING, Call, List, drop, fresh, give_back, inlined, new_ints
from opsim.engine.floor.random_numbers import MIX, ROUTING, START, number_at, stream_of
from opsim.engine.floor.records import Way
from opsim.engine.floor.state import Claim, Event, Gate, Job, Product, Station
from opsim.log import AFTER

new_claim = fresh(Claim)
_forget = give_back(Claim)


@inlined
def is_before(one: Claim, other: Claim) -> bool:
    """Whether one is served before another."""
    if one.before != other.before:
        return one.before < other.before
    if one.since_s != other.since_s:
        return one.since_s < other.since_s
    return one.number < other.number


@inlined
def put_claim(floor: Floor, claims: List[Claim], job: Job, since_s: float) -> None:
    """A job puts a claim down, at its place in the order."""
    claim: Claim = new_claim(floor)
    claim.before, claim.since_s, claim.number, claim.job = -job.priority, since_s, job.number, job
    at = len(claims)
    while at > 0 and is_before(claim, claims[at - 1]):
        at -= 1
    claims.insert(at, claim)


@inlined
def take_claim(floor: Floor, claims: List[Claim], at: int) -> None:
    """The claim number ``at`` is met, or given up."""
    claim = claims[at]
    del claims[at]
    claim.job = NOTHING
    _forget(floor, claim)


@inlined
def claim_at(claims: List[Claim], job: Job) -> int:
    """The number of a job's first claim; -1: it has none."""
    for at in range(len(claims)):
        if claims[at].job is job:
            return at
    return -1


@inlined
def give_up_claims(floor: Floor, claims: List[Claim], job: Job) -> bool:
    """The job claims nothing there any more; whether it did."""
    found = False
    for at in range(len(claims) - 1, -1, -1):
        if claims[at].job is job:
            take_claim(floor, claims, at)
            found = True
    return found


@inlined
def alarm(floor: Floor, delay_s: float, kind: int, rank: int, number: int, line: Call, subject: Any) -> Event:
    """A report after a delay, which is rounded to the grid. ``cancel`` makes it nothing."""
    event: Event = new_event(floor)
    event.line, event.alive = line, 1
    event.kind, event.rank, event.number = kind, rank, number
    event.subject = subject
    push_event(floor, floor.env_now + on_grid(delay_s), event)
    return event


@inlined
def cancel(event: Event) -> None:
    """An event that is to come will mean nothing. Nobody may refer to it after this."""
    event.alive = 0


@inlined
def stir_gate(floor: Floor, gate: Gate) -> None:
    """Whoever claims a place by a gate is looked at again."""
    if not gate.stirred:
        gate.stirred = 1
        floor.stirred.append(gate)


@inlined
def stir(floor: Floor, station: Station) -> None:
    """There may be room at a station: whoever wants in is looked at again."""
    if station.is_entry:
        floor.entries_full = 0
    for i in range(station.n_wanted_by):
        gate = station.wanted_by[i]
        if gate.claims:
            stir_gate(floor, gate)


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


@inlined
def taken(way: Way, point: float) -> int:
    """The step that a number in [0, 1) decides for."""
    i = 0
    while i < way.n - 1 and point >= way.cumulative[i]:
        i += 1
    return way.to[i]


@inlined
def first_step(floor: Floor, source: int, n: int, product: Product) -> int:
    """Where the n-th job of a source begins, drawn where there is a choice."""
    start = product.start
    if start.n == 1:
        return start.to[0]
    chances = product.start_chances
    while len(chances) <= source:
        chances.append(stream_of(floor, START, len(chances), 0, 0))
    return taken(start, number_at(floor, chances[source], n))


@inlined
def step_after(floor: Floor, job: Job) -> int:
    """The step of the route that follows, -1 for the way out; drawn by job number and visit where there is a choice."""
    here = job.plan.steps[job.step]
    way = here.way
    if way.n == 1:
        return way.to[0]
    if not job.visits:
        job.visits = new_ints(floor, job.plan.n_steps)
    visit = job.visits[job.step]
    job.visits[job.step] = visit + 1
    which = visit * floor.n_sources + job.source
    chances = here.chances
    while len(chances) <= which:
        n = len(chances)
        stream = stream_of(floor, ROUTING, job.operation, n % floor.n_sources, n // floor.n_sources)
        chances.append(stream)
    return taken(way, number_at(floor, chances[which], job.n))


@inlined
def product_of(floor: Floor, source: Source, n: int) -> int:
    """The rank of the product that the n-th job of a source is."""
    if source.n_sequence:
        return source.sequence[n % source.n_sequence]
    if source.n_orders and source.orders[0].product >= 0:
        low, high = 0, source.n_orders
        while high - low > 1:
            middle = (low + high) // 2
            if source.orders[middle].first <= n:
                low = middle
            else:
                high = middle
        return source.orders[low].product
    if source.n_mix <= 1:
        return source.ranks[0]
    if not source.mix:
        source.mix = stream_of(floor, MIX, source.rank, 0, 0)
    return int(number_at(floor, source.mix, n))


@inlined
def aim(job: Job, step: int) -> None:
    """The job's next operation is that of a step of its route."""
    job.step = step
    found = job.plan.steps[step]
    job.operation = found.operation
    job.gate = found.gate


@inlined
def place_of(claims: List[Claim], claim: Claim) -> int:
    """Where a claim, or its copy, is in a list in order, or would be."""
    low, high = 0, len(claims)
    while low < high:
        middle = (low + high) >> 1
        if is_before(claims[middle], claim):
            low = middle + 1
        else:
            high = middle
    return low


@inlined
def is_there(claims: List[Claim], copy: Claim) -> bool:
    """Whether the claim that something is a copy of is among all claims of the gate, in order."""
    at = place_of(claims, copy)
    if at == len(claims):
        return False
    return claims[at].job is copy.job and not is_before(copy, claims[at])
