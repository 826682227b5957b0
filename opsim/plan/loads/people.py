"""What people would have to do: by skill, and all together, where work is shared as well as it can be."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

from opsim.plan.loads.flows import Flow, Flows, flows_of
from opsim.plan.loads.work_sharing import best_share
from opsim.plan.loads.work_times import ANYBODY, WorkTimes, batch_size
from opsim.plan.plan import Plan


@dataclass(frozen=True, slots=True)
class SkillLoad:
    """A skill is the work at a station. able : how many have it; work_s : work of people a visit, on average over those
    at work, each at his own speed; at rating 1 where nobody is; wanted : how many of them it keeps busy (a day's work a
    day), for each job an hour where the floor decides what comes in; load : share of their time, if they did nothing
    else; None where the floor decides. Walks do not count.
    there : how many of the able are at work on the mean of the run: shifts, breaks and absence are taken out;
    with_overtime : the load if they stayed for all the overtime that they may; None where that changes nothing.
    """

    skill: str
    able: int
    work_s: float
    wanted: float
    load: float | None
    there: float = 0.0
    with_overtime: float | None = None


@dataclass(frozen=True, slots=True)
class Crew:
    """share : of their time at work that the busiest people work however well work is shared; skills, workers : of whom
    that is true; for each job an hour where the floor decides what comes in. with_overtime : as of a skill.
    """

    share: float
    skills: tuple[str, ...]
    workers: tuple[str, ...]
    with_overtime: float | None = None


def skill_loads(plan: Plan, flows: Flows | None = None, times: WorkTimes | None = None) -> list[SkillLoad]:
    """Load of each skill that is needed, in natural order."""
    flows, times = flows_of(plan) if flows is None else flows, WorkTimes(plan) if times is None else times
    return [_skill_load(one, flows, times) for one in _by_hand(plan, flows, times)]


@dataclass(frozen=True, slots=True)
class HandWork:
    """station : its rank; per_s : visits a second; worker_s : how long people are at work in one, by who can do it;
    anybody_s : the same at rating 1.
    """

    station: int
    per_s: float
    worker_s: dict[int, float]
    anybody_s: float

    def mean_s(self, share: Sequence[float]) -> float:
        """Of a visit, where all of them are at work for the same part of the time that they are there."""
        there = sum(share[worker] for worker in self.worker_s)
        return there / sum(share[worker] / s for worker, s in self.worker_s.items()) if there else self.anybody_s


def _skill_load(work: HandWork, flows: Flows, times: WorkTimes) -> SkillLoad:
    hours, able = times.hours, work.worker_s
    there, more = (sum(share[worker] for worker in able) for share in (hours.share, hours.share_with_overtime))
    mean_s, more_s = work.mean_s(hours.share), work.mean_s(hours.share_with_overtime)
    load = late = None
    if able and not flows.saturated:
        load, late = (work.per_s * s / n if n else inf for s, n in ((mean_s, there), (more_s, more)))
    name = times.plan.stations[work.station].name
    late = late if late is not None and load is not None and late < load else None
    return SkillLoad(name, len(able), mean_s, work.per_s * mean_s, load, there, late)


def crew_load(plan: Plan, flows: Flows | None = None, times: WorkTimes | None = None) -> Crew | None:
    """The people who are worked hardest; None where nobody is needed, or nobody is ever there."""
    flows, times = flows_of(plan) if flows is None else flows, WorkTimes(plan) if times is None else times
    hours = times.hours
    wanted = {one.station: one for one in _by_hand(plan, flows, times)}
    there = {rank: {n: s for n, s in one.worker_s.items() if hours.share[n] > 0} for rank, one in wanted.items()}
    work = {rank: wanted[rank].per_s for rank, able in there.items() if able}
    found = best_share(work, there, hours.share)
    if found is None:
        return None
    share, skills = found
    people = sorted({n for rank in skills for n in there[rank]})
    longer = hours.share_with_overtime
    more = None if longer == hours.share else best_share(work, there, longer)
    names = tuple(plan.stations[rank].name for rank in skills)
    with_overtime = more[0] if more is not None and more[0] < share * (1 - 1e-9) else None
    return Crew(share, names, tuple(plan.workers[n].name for n in people), with_overtime)


def worked_by_hand(plan: Plan, flows: Flows) -> set[int]:
    """Ranks of the stations where people have something to do, whichever source lets the jobs in."""
    times, found = WorkTimes(plan), set()
    for station, here in _flows_at(flows).items():
        come = [flow for flow in here if flow.per_h or flow.per_job]
        work_s = sum(times.by_hand_s(ANYBODY, station, flow.product) for flow in come)
        if come and work_s + times.setup_by_hand_s(ANYBODY, station, come) > 0:
            found.add(station)
    return found


def _flows_at(flows: Flows) -> dict[int, list[Flow]]:
    here: defaultdict[int, list[Flow]] = defaultdict(list)
    for flow in flows.steps:
        here[flow.station].append(flow)
    return here


def _by_hand(plan: Plan, flows: Flows, times: WorkTimes) -> list[HandWork]:
    """All work of people that loads count, by station in natural order; where the floor decides, of what it lets in."""
    here = _flows_at(flows)
    found = [_hand_work(plan, station, here[station], flows.saturated, times) for station in sorted(here)]
    return [one for one in found if one.per_s * one.anybody_s > 0]


def _hand_work(plan: Plan, station: int, here: list[Flow], saturated: bool, times: WorkTimes) -> HandWork:
    visits = {flow: flow.per_job if saturated else flow.per_h for flow in here}
    total, known = sum(visits.values()), {}

    def visit_s(worker: int) -> float:
        by_hand_s = sum(n * times.by_hand_s(worker, station, flow.product) for flow, n in visits.items())
        return by_hand_s / total / batch_size(plan, station) + times.setup_by_hand_s(worker, station, here)

    def as_fast_s(worker: int) -> float:
        person = plan.workers[worker]
        key = (person.rating[station], worker if person.body.said else ANYBODY)
        if key not in known:
            known[key] = visit_s(worker)
        return known[key]

    if not total or not visit_s(ANYBODY):
        return HandWork(station, 0.0, {}, 0.0)
    able = sorted(times.hours.able(station))
    return HandWork(station, total / 3600, {worker: as_fast_s(worker) for worker in able}, visit_s(ANYBODY))
