"""Rules by which jobs are taken out of queues, and by which one of several stations is.

Which waiting job is next, and which of several stations a job goes to, where the plan names a rule, ours or not.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import struct
from opsim.engine.floor.setups import setup_s
from opsim.engine.floor.state import GOES_ON
from opsim.engine.rules import queue_key
from opsim.plan.sequence import SHORTEST_QUEUE
from opsim.plugins import rule_of


@struct
class Sequence:
    """rule : its number in ``sequence.SEQUENCING`` or ``ROUTING``; has_ahead : whether mean times are known."""

    rule: int
    has_ahead: int


def order(floor: Any, station: Any, job: Any) -> bool:
    """Put the key by which the next job of a queue is chosen."""
    known = station.order.subject
    work_s = left_s = left_steps = 0.0
    if known.has_ahead:
        plan, step = job.plan, job.step
        work_s = plan.at_s[station.rank]
        left_s = work_s + (plan.left_s[step] - plan.work_s[step])
        left_steps = plan.left_steps[step]
    key = known.rule(
        *(floor.now, job.since_s, work_s, left_s, left_steps, job.due_s, setup_s(station, job), job.number)
    )
    floor.key = queue_key(job.priority, job.stage == GOES_ON, *key)
    return True


def choose(floor: Any, known: Any, station: Any, job: Any) -> bool:
    """Put the key by which one of several stations is chosen for a job."""
    at = job.ahead.step if job.ahead else job.step
    metres = 0.0
    if job.station.rank >= 0:
        metres = floor.distance_m[job.station.place * floor.n_places + station.place]
    mean_s = job.plan.at_s[station.rank] if known.has_ahead else 0.0
    floor.key = known.rule(
        station.n_inside - len(station.put_away),
        station.servers,
        station.rank,
        station.free_servers,
        mean_s,
        setup_s(station, job),
        metres,
        job.plan.steps[at].position[station.rank],
    )
    return True


def install(build: Any) -> None:
    """Queues with a rule or priorities, and steps of several stations with a rule."""
    plan = build.plan
    for queue in plan.queues:
        known = _known(build, rule_of("opsim.sequencing", queue.rule))
        build.stations[queue.station].order = build.hook(order, known)
    crowded = {rank for rank, station in enumerate(plan.stations) if station.buffer_after}
    for ranks, gate in build.gates.items():
        if len(ranks) > 1 and (plan.routing != SHORTEST_QUEUE or crowded.intersection(ranks)):
            gate.choose = build.hook(choose, _known(build, rule_of("opsim.routing", plan.routing)))


def _known(build: Any, rule: Any) -> Sequence:
    made: Sequence = build.arena.new("Sequence")
    made.rule, made.has_ahead = rule, build.plan.ahead is not None
    return made
