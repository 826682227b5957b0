"""Which waiting job is next, and which of several stations a job goes to, where the plan names a rule, ours or not."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.keys import put_queue_key, put_station_key, queue_rule, routing_rule
from opsim.engine.floor.machine import Handle, cast, step, struct
from opsim.engine.floor.state import GOES_ON, Job, Station
from opsim.subjects.sequencing.plan import SHORTEST_QUEUE
from opsim.subjects.sequencing.setups import setup_s


@struct
class Sequence:
    """rule : as ``keys`` knows it; has_ahead : whether mean times are known."""

    rule: int
    has_ahead: int


_as_sequence = cast(Sequence)


@step
def order(floor: Floor, station: Station, job: Job) -> bool:
    """Put the key by which the next job of a queue is chosen."""
    known: Sequence = _as_sequence(station.order.subject)
    work_s = left_s = left_steps = 0.0
    if known.has_ahead:
        plan, at = job.plan, job.step
        work_s = plan.at_s[station.rank]
        left_s = work_s + (plan.left_s[at] - plan.work_s[at])
        left_steps = plan.left_steps[at]
    put_queue_key(floor, known.rule, job, work_s, left_s, left_steps, setup_s(station, job), job.stage == GOES_ON)
    return True


@step
def choose(floor: Floor, known: Sequence, station: Station, job: Job) -> bool:
    """Put the key by which one of several stations is chosen for a job."""
    at = job.ahead.step if job.ahead else job.step
    metres = 0.0
    if job.station.rank >= 0:
        metres = floor.distance_m[job.station.place * floor.n_places + station.place]
    mean_s = job.plan.at_s[station.rank] if known.has_ahead else 0.0
    position = job.plan.steps[at].position[station.rank]
    put_station_key(floor, known.rule, station, mean_s, setup_s(station, job), metres, position)
    return True


def install(build: Any) -> None:
    """Queues with a rule or priorities, and steps of several stations with a rule."""
    plan = build.plan
    for queue in plan.queues:
        build.stations[queue.station].order = build.hook(order, _known(build, queue_rule(queue.rule)))
    crowded = {rank for rank, station in enumerate(plan.stations) if station.buffer_after}
    for ranks, gate in build.gates.items():
        if len(ranks) > 1 and (plan.routing != SHORTEST_QUEUE or crowded.intersection(ranks)):
            gate.choose = build.hook(choose, _known(build, routing_rule(plan.routing)))


def _known(build: Any, rule: Any) -> Handle:
    made: Handle = build.arena.new("Sequence")
    made.rule, made.has_ahead = rule, build.plan.ahead is not None
    return made
