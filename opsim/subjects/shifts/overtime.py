"""What jobs can come to in time: through stations that work alone, or where somebody is; not past a run that lasts.

Overtime: who stays on after his shift while jobs on the floor need him, and nobody whose shift it is.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.event_list import INF
from opsim.engine.floor.floor_state import CREWS, DUTY, LINES, Floor
from opsim.engine.floor.machine import Array, fresh, inlined, new_ints, step
from opsim.engine.floor.state import Gate, Job, Product, Worker
from opsim.log import HELD, QUEUE, SETUP, TRANSPORT, WORK
from opsim.subjects.people.worker import has_bit, set_bit
from opsim.subjects.shifts.shifts import GONE, Known, Needs, Presence

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


@step
def need(floor: Floor, one: Presence) -> bool:
    """Whether a job on the floor comes to where he can do something before his overtime is over, and too few of those
    whose shift it is can.
    """
    worker, needs = one.worker, floor.people.needs
    until_s = one.duty.end_s + one.duty.overtime_s
    _see_open(floor, needs, until_s)
    if worker.tied and worker.tied.kind == HELD and needs.opens[worker.tied.station.rank]:
        return True
    if not _find_lacking(floor, needs, worker):
        return False
    if _has_to_carry(floor, needs, worker):
        return True
    _find_passed(floor, needs, worker)
    hold_up(floor, needs, until_s)
    find_reached(floor, needs)
    job = floor.first_job
    while job:
        comes = needs.comes[needs.first_step[job.product] + job.step]
        if comes and job.station.rank >= 0 and not _is_of_gone(floor, job) and not lasts(job, until_s):
            return True
        job = job.next_on_floor
    return False


@inlined
def _is_gone(worker: Worker) -> bool:
    """Whether somebody is off or absent, or as good as that."""
    other = worker.presence
    if not other:
        return False
    return other.state == GONE or other.goes == 1


@inlined
def _is_of_gone(floor: Floor, job: Job) -> bool:
    """Whether the job waits for somebody who is gone: nobody else serves it."""
    if floor.people.n_tied:
        for rank in range(floor.n_workers):
            if floor.workers[rank].tied is job and _is_gone(floor.workers[rank]):
                return True
    return False


@inlined
def _is_on_duty(worker: Worker) -> bool:
    """Whether it is the shift of somebody who is there."""
    other = worker.presence
    if not other:
        return True
    return not other.overtime


@inlined
def _see_skills_but_for(floor: Floor, needs: Needs, worker: Worker, lines: bool) -> None:
    """The stations that his ratings leave him and all limits but those of his shift, of crews, and of ``lines``."""
    for word in range(floor.n_words):
        left = worker.own_skills[word]
        for limit in range(floor.n_limits):
            if worker.limited[limit] and limit != DUTY and limit != CREWS and not (lines and limit == LINES):
                left &= worker.limits[limit * floor.n_words + word]
        needs.mine[word] = left


@inlined
def _count_able(floor: Floor, needs: Needs) -> None:
    """One more who can work at the stations of ``needs.mine``."""
    for rank in range(floor.n_stations):
        if has_bit(needs.mine, rank):
            needs.n_able[rank] += 1


@step
def _find_lacking(floor: Floor, needs: Needs, worker: Worker) -> bool:
    """The stations where he may be sent or called, and fewer of the others than their tasks take; whether any are."""
    for rank in range(floor.n_stations):
        needs.n_able[rank] = 0
    for rank in range(floor.n_workers):
        other = floor.workers[rank]
        if other is not worker and not _is_gone(other) and _is_on_duty(other):
            _see_skills_but_for(floor, needs, other, False)
            _count_able(floor, needs)
    _clear_bits(floor, needs.lacking)
    _see_skills_but_for(floor, needs, worker, True)
    found = False
    for rank in range(floor.n_stations):
        if has_bit(needs.mine, rank) and needs.opens[rank] and needs.n_able[rank] < needs.at_once[rank]:
            set_bit(needs.lacking, rank)
            found = True
    return found


@step
def _find_passed(floor: Floor, needs: Needs, worker: Worker) -> None:
    """The stations that jobs get through: by themselves, or since enough are there who can serve them."""
    for rank in range(floor.n_stations):
        needs.n_able[rank] = 0
    for rank in range(floor.n_workers):
        other = floor.workers[rank]
        if other is worker or not _is_gone(other):
            _see_skills_but_for(floor, needs, other, True)
            _count_able(floor, needs)
    _clear_bits(floor, needs.passed)
    for rank in range(floor.n_stations):
        if needs.n_able[rank] >= needs.at_once[rank] and needs.opens[rank]:
            set_bit(needs.passed, rank)


@step
def _has_to_carry(floor: Floor, needs: Needs, worker: Worker) -> bool:
    """Whether a job that he has to carry, or somebody, is where others lack."""
    people = floor.people
    if worker.tied and has_bit(needs.lacking, worker.tied.station.rank):
        return True
    for one in people.left:
        if has_bit(needs.lacking, one.job.station.rank):
            return True
    job = worker.job
    if job and job.held_by is worker and job.plan.carried:
        return has_bit(needs.lacking, job.station.rank)
    return False


@inlined
def _clear_bits(floor: Floor, bits: Array[int]) -> None:
    for word in range(floor.n_words):
        bits[word] = 0


@inlined
def _next_open(needs: Needs, rank: int, at_s: float) -> float:
    """The first time from ``at_s`` on at which a station with hours is open; inf where there is none in the run."""
    first = needs.first_open[rank]
    for i in range(needs.n_open[rank]):
        if at_s < needs.open_s[first + 2 * i + 1]:
            return max(at_s, needs.open_s[first + 2 * i])
    return INF


@inlined
def _see_open(floor: Floor, needs: Needs, until_s: float) -> None:
    """Which stations are open, or will be before a time."""
    for rank in range(floor.n_stations):
        needs.opens[rank] = needs.n_open[rank] < 0 or _next_open(needs, rank, floor.now) < until_s


def set_needs(build: Any, people: Any) -> None:
    """What is known of stations and products."""
    plan, made = build.plan, build.arena.new("Needs")
    people.needs, n_stations = made, len(plan.stations)
    made.at_once = build.ints(_at_once(plan, station) for station in plan.stations)
    hours = [station.open_s for station in plan.stations]
    made.n_open = build.ints(-1 if open_s is None else len(open_s) for open_s in hours)
    edges = [[edge for pair in open_s or () for edge in pair] for open_s in hours]
    made.first_open = build.ints(sum(map(len, edges[:rank])) for rank in range(n_stations))
    made.open_s = build.floats(edge for mine in edges for edge in mine)
    n_steps = [len(product.route) for product in plan.products]
    made.first_step = build.ints(sum(n_steps[:rank]) for rank in range(len(n_steps)))
    made.n_steps, made.last = sum(n_steps), build.ints([0] * sum(n_steps))
    made.opens, made.n_able = build.ints([0] * n_stations), build.ints([0] * n_stations)
    for name in ("mine", "lacking", "passed", "held"):
        setattr(made, name, build.ints([0] * build.floor.n_words))


def _at_once(plan: Any, station: Any) -> int:
    tasks = [plan.tasks[task] for task in station.tasks]
    return max((task.team for task in tasks if not task.automatic), default=0)
