"""Which waiting job is next, and which of several stations a job goes to, where the plan names a rule."""

from collections.abc import Callable

from opsim.engine.rules.sequencing import queue_key
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.setup import setup_s
from opsim.engine.simpy_engine.state import GOES_ON, OUTSIDE, Gate, Job, Station
from opsim.plan import Plan
from opsim.plan.sequence import SHORTEST_QUEUE, QueuePlan
from opsim.plugins import rule_of


def install(floor: Floor) -> None:
    """Queues with a rule or priorities, and steps of several stations with a rule."""
    for queue in floor.plan.queues:
        station = floor.stations[queue.station]
        station.order = _order(floor, station, queue)
    crowded = [station for station in floor.stations if station.plan.buffer_after]
    for gate in floor.gates.values():
        if len(gate.stations) > 1 and (
            floor.plan.routing != SHORTEST_QUEUE or any(one in crowded for one in gate.stations)
        ):
            gate.choose = _choice(floor, gate)


def _order(floor: Floor, station: Station, queue: QueuePlan) -> Callable[[Job], tuple[float, ...]]:
    rule, plan = rule_of("opsim.sequencing", queue.rule), floor.plan

    def order(job: Job) -> tuple[float, ...]:
        work_s, left_s, left_steps = _ahead_of(plan, station, job)
        key = rule(*(floor.now, job.since_s, work_s, left_s, left_steps, job.due_s, setup_s(station, job), job.number))
        return queue_key(job.priority, job.stage == GOES_ON, *key)

    return order


def _ahead_of(plan: Plan, station: Station, job: Job) -> tuple[float, float, float]:
    """Mean work of the operation a job waits for, of all that is left, and how many operations these are."""
    ahead = plan.ahead
    if ahead is None:
        return 0.0, 0.0, 0.0
    here_s = ahead.at_s[job.product][station.rank]
    later_s = ahead.left_s[job.product][job.step] - ahead.work_s[job.product][job.step]
    return here_s, here_s + later_s, ahead.left_steps[job.product][job.step]


def _choice(floor: Floor, gate: Gate) -> Callable[[list[Station], Job], Station]:
    rule, ahead = rule_of("opsim.routing", floor.plan.routing), floor.plan.ahead

    def key(station: Station, job: Job) -> tuple[float, ...]:
        step = job.step if job.ahead is None else job.ahead.step
        listed = floor.steps[job.product][step][0].listed
        metres = 0.0 if job.station is OUTSIDE else floor.plan.distance_m[job.station.place][station.place]
        return rule(
            station.n_inside - len(station.put_away),
            station.plan.servers,
            station.rank,
            station.free_servers,
            0.0 if ahead is None else ahead.at_s[job.product][station.rank],
            setup_s(station, job),
            metres,
            listed.index(station.rank),
        )

    return lambda with_room, job: min(with_room, key=lambda station: key(station, job))
