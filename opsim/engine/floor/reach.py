"""What jobs can come to in time: through stations that work alone, or where somebody is; not past a run that lasts."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, fresh, inlined, new_ints, step
from opsim.engine.floor.parts.bits import has_bit, set_bit
from opsim.engine.floor.parts.people import Known, Needs
from opsim.engine.floor.parts.records import Product
from opsim.engine.floor.parts.state import Floor, Gate, Job
from opsim.log import QUEUE, SETUP, TRANSPORT, WORK

EMPTY, ALL_LAST, OTHERS = range(3)
"""What is inside a station: nothing, only runs that last, or something else as well."""
MOST_KNOWN = 64
"""Answers that are kept."""
_new_known = fresh(Known)


@inlined
def lasts(job: Job, until_s: float) -> bool:
    """Whether an automatic run of a job is under way that is not over before a time."""
    runs = (job.kind == WORK or job.kind == SETUP) and job.worker < 0 and not job.has_team
    return runs and job.since_s + job.duration_s >= until_s


@step
def hold_up(floor: Floor, needs: Needs, until_s: float) -> None:
    """The stations where runs that last until some time have all servers: nobody else gets in before it."""
    inside = needs.n_able  # NOTE: who can work where is asked no more by now
    for rank in range(floor.n_stations):
        inside[rank] = EMPTY
    job = floor.first_job
    while job:
        rank = job.station.rank
        if rank >= 0 and job.kind != QUEUE and job.kind != TRANSPORT and inside[rank] != OTHERS:
            inside[rank] = ALL_LAST if lasts(job, until_s) else OTHERS
        job = job.next_on_floor
    for word in range(floor.n_words):
        needs.held[word] = 0
    for rank in range(floor.n_stations):
        if inside[rank] == ALL_LAST and floor.stations[rank].free_servers == 0:
            set_bit(needs.held, rank)


@step
def find_reached(floor: Floor, needs: Needs) -> None:
    """``needs.comes``: by product and step, whether a job comes to stations where somebody lacks."""
    for word in range(floor.n_words):
        needs.lacking[word] &= ~needs.held[word]
        needs.passed[word] &= ~needs.held[word]
    for known in needs.known:
        if _are_same(floor, known.wanted, needs.lacking) and _are_same(floor, known.passed, needs.passed):
            needs.comes = known.comes
            return
    if len(needs.known) < MOST_KNOWN:
        known = _new_known(floor)
        known.wanted, known.passed = _copy(floor, needs.lacking), _copy(floor, needs.passed)
        known.comes = new_ints(floor, needs.n_steps)
        needs.known.append(known)
        needs.comes = known.comes
    else:
        needs.comes = needs.last
    for rank in range(floor.n_products):
        _find_comes(floor, needs, floor.products[rank])


@step
def _find_comes(floor: Floor, needs: Needs, product: Product) -> None:
    """The same of one product."""
    first = needs.first_step[product.rank]
    for i in range(product.n_steps):
        needs.comes[first + i] = _are_some(product.steps[i].gate, needs.lacking)
    changed = True
    while changed:
        changed = False
        for i in range(product.n_steps):
            if not needs.comes[first + i] and _are_some(product.steps[i].gate, needs.passed):
                way = product.steps[i].way
                for one in range(way.n):
                    if way.to[one] >= 0 and needs.comes[first + way.to[one]]:
                        needs.comes[first + i] = 1
                        changed = True


@inlined
def _are_some(gate: Gate, stations: Array[int]) -> bool:
    """Whether one of the stations behind a gate is among some."""
    for i in range(gate.n_stations):
        if has_bit(stations, gate.stations[i].rank):
            return True
    return False


@inlined
def _are_same(floor: Floor, one: Array[int], other: Array[int]) -> bool:
    for word in range(floor.n_words):
        if one[word] != other[word]:
            return False
    return True


@inlined
def _copy(floor: Floor, bits: Array[int]) -> Array[int]:
    made = new_ints(floor, floor.n_words)
    for word in range(floor.n_words):
        made[word] = bits[word]
    return made
