"""Rules by which jobs are taken out of queues, and by which one of several stations is.

Which waiting job is next, and which of several stations a job goes to, where the plan names a rule.
"""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.fast_engine.floor_state import Floor
from opsim.engine.fast_engine.keys import begin_key, put
from opsim.engine.fast_engine.machine import Handle, cast, inlined, step, struct
from opsim.engine.fast_engine.setups import setup_s
from opsim.engine.fast_engine.state import GOES_ON, Job, Station
from opsim.engine.rules import ROUTING_RULES, SEQUENCING_RULES
from opsim.plan.sequence import SHORTEST_QUEUE


@struct
class Sequence:
    """rule : its number in ``sequence.SEQUENCING`` or ``ROUTING``; has_ahead : whether mean times are known."""

    rule: int
    has_ahead: int


SEQUENCING, ROUTING = tuple(SEQUENCING_RULES), tuple(ROUTING_RULES)
"""Rules by their numbers."""
_fifo, _spt, _edd = map(inlined, (rules.fifo, rules.spt, rules.edd))
_critical_ratio, _least_setup = inlined(rules.critical_ratio), inlined(rules.least_setup)
_downstream_first = inlined(rules.downstream_first)
_queue_key = inlined(rules.queue_key)
_shortest_queue, _least_loaded = inlined(rules.shortest_queue), inlined(rules.least_loaded)
_first_free, _in_order = inlined(rules.first_free), inlined(rules.in_order)
_as_sequence = cast(Sequence)


@step
def order(floor: Floor, station: Station, job: Job) -> bool:
    """Put the key by which the next job of a queue is chosen."""
    known: Sequence = _as_sequence(station.order.subject)
    work_s = left_s = left_steps = 0.0
    if known.has_ahead:
        plan, step = job.plan, job.step
        work_s = plan.at_s[station.rank]
        left_s = work_s + (plan.left_s[step] - plan.work_s[step])
        left_steps = plan.left_steps[step]
    begun = job.stage == GOES_ON
    since_s, number = job.since_s, float(job.number)
    begin_key(floor)
    if known.rule == 0:
        key = _fifo(floor.now, since_s, work_s, left_s, left_steps, job.due_s, 0.0, number)
        first = _queue_key(job.priority, begun, key[0], key[1])
        put(floor, first[0])
        put(floor, 1.0 if first[1] else 0.0)
        put(floor, first[2])
        put(floor, first[3])
        return True
    needed_s = setup_s(station, job)
    if known.rule == 1:
        found = _spt(floor.now, since_s, work_s, left_s, left_steps, job.due_s, needed_s, number)
    elif known.rule == 2:
        found = _edd(floor.now, since_s, work_s, left_s, left_steps, job.due_s, needed_s, number)
    elif known.rule == 3:
        found = _critical_ratio(floor.now, since_s, work_s, left_s, left_steps, job.due_s, needed_s, number)
    elif known.rule == 4:
        found = _least_setup(floor.now, since_s, work_s, left_s, left_steps, job.due_s, needed_s, number)
    else:
        found = _downstream_first(floor.now, since_s, work_s, left_s, left_steps, job.due_s, needed_s, number)
    whole = _queue_key(job.priority, begun, found[0], found[1], found[2])
    put(floor, whole[0])
    put(floor, 1.0 if whole[1] else 0.0)
    put(floor, whole[2])
    put(floor, whole[3])
    put(floor, whole[4])
    return True


@step
def choose(floor: Floor, known: Sequence, station: Station, job: Job) -> bool:
    """Put the key by which one of several stations is chosen for a job."""
    at = job.ahead.step if job.ahead else job.step
    position = float(job.plan.steps[at].position[station.rank])
    metres = 0.0
    if job.station.rank >= 0:
        metres = floor.distance_m[job.station.place * floor.n_places + station.place]
    mean_s = job.plan.at_s[station.rank] if known.has_ahead else 0.0
    n_inside, servers = float(station.n_inside - len(station.put_away)), float(station.servers)
    rank, n_free, needed_s = float(station.rank), float(station.free_servers), setup_s(station, job)
    if known.rule == 2:
        first = _first_free(n_inside, servers, rank, n_free, mean_s, needed_s, metres, position)
        put(floor, first[0])
        put(floor, first[1])
        put(floor, first[2])
        return True
    if known.rule == 0:
        key = _shortest_queue(n_inside, servers, rank, n_free, mean_s, needed_s, metres, position)
    elif known.rule == 1:
        key = _least_loaded(n_inside, servers, rank, n_free, mean_s, needed_s, metres, position)
    else:
        key = _in_order(n_inside, servers, rank, n_free, mean_s, needed_s, metres, position)
    put(floor, key[0])
    put(floor, key[1])
    return True


def install(build: Any) -> None:
    """Queues with a rule or priorities, and steps of several stations with a rule."""
    plan = build.plan
    for queue in plan.queues:
        build.stations[queue.station].order = build.hook(order, _known(build, SEQUENCING.index(queue.rule)))
    crowded = {rank for rank, station in enumerate(plan.stations) if station.buffer_after}
    for ranks, gate in build.gates.items():
        if len(ranks) > 1 and (plan.routing != SHORTEST_QUEUE or crowded.intersection(ranks)):
            gate.choose = build.hook(choose, _known(build, ROUTING.index(plan.routing)))


def _known(build: Any, rule: int) -> Handle:
    made: Handle = build.arena.new("Sequence")
    made.rule, made.has_ahead = rule, build.plan.ahead is not None
    return made


assert SEQUENCING == ("fifo", "spt", "edd", "critical_ratio", "least_setup", "downstream_first"), "see order"
assert ROUTING == ("shortest_queue", "least_loaded", "first_free", "in_order"), "see choose"
