"""Defects are left, found or missed; what is turned down is scrapped, or goes back for rework."""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.flow import go_to, leave_floor, leave_station, withdraw
from opsim.engine.floor.log_rows import log_instant
from opsim.engine.floor.machine import Array, List, index_of, inlined, step, struct
from opsim.engine.floor.random_numbers import QUALITY, YIELD, number_at, stream_of
from opsim.engine.floor.records import Stream
from opsim.engine.floor.state import Job, Station, Worker
from opsim.log import BAD, FALSE_ALARM, REWORK, SCRAP
from opsim.subjects.quality.plan import NOWHERE


@struct
class Chances:
    """Streams of an operation, by visit x sources + source."""

    streams: List[Stream]


@struct
class Gauge:
    """Of a station, see ``plan.QualityPlan``. back : by product x n_steps + step, -1: nowhere; n_steps 0: always scrap

    yields, chances : by operation
    """

    station: int
    yield_share: float
    inspects: int
    finds: float
    false_alarms: float
    by_worker: int
    n_steps: int
    back: Array[int]
    most: float
    yields: Array[Chances]
    chances: Array[Chances]


@inlined
def counted(floor: Floor, counts: List[int], rank: int) -> int:
    """How often so far, where it may be that it was never."""
    while len(counts) <= rank:
        counts.append(0)
    return counts[rank]


ORDER = 10
"""Among what is asked when an operation is done."""
ACT = 45
"""Among the ways to begin a task: after those who do not begin it yet, or take over."""
_leaves_defect, _share_of_good = inlined(rules.leaves_defect), inlined(rules.share_of_good)
_turned_down, _reworked = inlined(rules.turned_down), inlined(rules.reworked)


def install(build: Any) -> None:
    """A look at each job at the stations where something goes wrong, or is looked at."""
    if not build.plan.quality:
        return
    yields, chances = (_chances(build) for _ in range(2))
    for plan in build.plan.quality:
        station, gauge = build.stations[plan.station], _gauge(build, plan)
        gauge.yields, gauge.chances = yields, chances
        build.hang(station.afters, looked_at, gauge, ORDER)
        if plan.by_worker:
            build.keep_jobs()
            build.hang(station.acts, note, gauge, ACT)


def _chances(build: Any) -> Any:
    """Streams of each operation, which the gauges share."""
    return build.arena.array("Chances", [build.arena.new("Chances") for _ in build.plan.operations])


def _gauge(build: Any, plan: Any) -> Any:
    made = build.arena.new("Gauge")
    made.station, made.yield_share, made.inspects, made.by_worker = (
        *(plan.station, plan.yield_share, plan.inspects, plan.by_worker),
    )
    made.finds, made.false_alarms, made.most = plan.finds, plan.false_alarms, plan.most
    made.n_steps = max((len(back) for back in plan.back), default=0)
    made.back = build.ints(step for back in plan.back for step in (*back, *[NOWHERE] * (made.n_steps - len(back))))
    return made


@step
def looked_at(floor: Floor, gauge: Gauge, job: Job) -> bool:
    """What becomes of a job whose operation at a station is done: True where it goes on as its way leads."""
    operation = job.operation
    visit = counted(floor, job.passes, operation)
    job.passes[operation] = visit + 1
    good = gauge.yield_share
    if gauge.by_worker:
        good = _share_of_good(good, _worst(gauge, job))
    if good < 1 and _leaves_defect(_chance(floor, gauge.yields[operation], YIELD, visit, job), good):
        job.bad = 1
    if not gauge.inspects:
        return True
    chance = 0.0
    if _is_open(gauge, job.bad):
        chance = _chance(floor, gauge.chances[operation], QUALITY, visit, job)
    if not _turned_down(chance, job.bad, gauge.finds, gauge.false_alarms):
        return True
    turn_down(floor, gauge, job, BAD if job.bad else FALSE_ALARM)
    return False


@inlined
def _chance(floor: Floor, chances: Chances, purpose: int, visit: int, job: Job) -> float:
    """The number in [0, 1) of this operation on this job."""
    which = visit * floor.n_sources + job.source
    streams = chances.streams
    while len(streams) <= which:
        n = len(streams)
        streams.append(stream_of(floor, purpose, job.operation, n % floor.n_sources, n // floor.n_sources))
    return number_at(floor, streams[which], job.n)


@inlined
def _is_open(gauge: Gauge, bad: int) -> bool:
    """Whether an inspection of such a job may end either way."""
    share = gauge.finds if bad else gauge.false_alarms
    return share > 0 and share < 1


@inlined
def _worst(gauge: Gauge, job: Job) -> float:
    """The share of good work of the worst of those who worked on the job here, which is forgotten with this."""
    at = index_of(job.block.worst_at, gauge.station)
    if at < 0:
        return 1.0
    worst = job.block.worst[at]
    job.block.worst[at] = 1.0
    return worst


@step
def note(floor: Floor, gauge: Gauge, job: Job, worker: Worker) -> bool:
    """Somebody works on the job, and on those that are with it: of several, the worst counts. Never sees to it."""
    station = job.station
    if station.down or job.setup_task >= 0:
        return False
    good = worker.quality[station.rank] * _share_of_good_by(floor, worker, station)
    if good < 1:
        _see_worse(floor, gauge, job, good)
        for other in job.members:
            _see_worse(floor, gauge, other, good)
    return False


@inlined
def _share_of_good_by(floor: Floor, worker: Worker, station: Station) -> float:
    """Of what he begins now; 1.0 where errors have nothing to do with fatigue, or nobody tires."""
    if not floor.errors_line or not worker.human:
        return 1.0
    floor.errors_line(floor, worker, station)
    return floor.asked_s


@step
def _see_worse(floor: Floor, gauge: Gauge, job: Job, good: float) -> None:
    """The share counts, where it is the least so far. NOTE: 1.0 stands for none."""
    at = index_of(job.block.worst_at, gauge.station)
    if at < 0:
        job.block.worst_at.append(gauge.station)
        job.block.worst.append(good)
    elif good < job.block.worst[at]:
        job.block.worst[at] = good


@step
def turn_down(floor: Floor, gauge: Gauge, job: Job, cause: int) -> None:
    """The job goes back, or is scrapped."""
    station = job.station
    if job.ahead:
        withdraw(floor, job)
    back = gauge.back[job.product * gauge.n_steps + job.step] if gauge.n_steps else NOWHERE
    reworks = counted(floor, job.reworks, station.rank)
    if back == NOWHERE or not _reworked(reworks, gauge.most):
        leave_station(floor, job)
        leave_floor(floor, job, SCRAP, cause, station.rank, -1)
        return
    job.reworks[station.rank] = reworks + 1
    log_instant(floor, REWORK, job, cause, station.rank, -1)
    job.bad = 0
    go_to(floor, job, back)
