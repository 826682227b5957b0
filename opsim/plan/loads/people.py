"""What people would have to do: by skill, and all together, where work is shared as well as it can be."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from dataclasses import dataclass
from itertools import compress

from opsim.plan.loads.rates import Flows, flows_of
from opsim.plan.loads.sharing import best_share
from opsim.plan.loads.work import batch_size, setup_of, setup_s, task_s
from opsim.plan.plan import Plan


@dataclass(frozen=True, slots=True)
class SkillLoad:
    """A skill is the work at a station. able : how many have it; work_s : work of people a visit at rating 1;
    wanted : how many of them it keeps busy (a day's work a day), for each job an hour where the floor decides what
    comes in; load : share of their time, if they did nothing else; None where the floor decides. Walks do not count.
    """

    skill: str
    able: int
    work_s: float
    wanted: float
    load: float | None


@dataclass(frozen=True, slots=True)
class Crew:
    """share : of their time that the busiest people work however well work is shared; skills, workers : of whom that
    is true; for each job an hour where the floor decides what comes in.
    """

    share: float
    skills: tuple[str, ...]
    workers: tuple[str, ...]


def skill_loads(plan: Plan, flows: Flows | None = None) -> list[SkillLoad]:
    """Load of each skill that is needed, in natural order."""
    flows = flows_of(plan) if flows is None else flows
    found, able = [], _able(plan)
    for rank, (work_s, wanted) in sorted(_wanted(plan, flows).items()):
        ratings = able[rank].values()
        load = None if flows.saturated or not ratings else wanted / sum(ratings)
        found.append(SkillLoad(plan.stations[rank].name, len(ratings), work_s, wanted, load))
    return found


def crew_load(plan: Plan, flows: Flows | None = None) -> Crew | None:
    """The people who are worked hardest; None where nobody is needed."""
    wanted = _wanted(plan, flows_of(plan) if flows is None else flows)
    able = {rank: people for rank, people in _able(plan).items() if rank in wanted and people}
    work = {rank: wanted[rank][1] / _mean(people.values()) for rank, people in able.items()}
    found = best_share(work, {rank: tuple(people) for rank, people in able.items()})
    if found is None:
        return None
    share, skills = found
    people = sorted({n for rank in skills for n in able[rank]})
    return Crew(share, tuple(plan.stations[rank].name for rank in skills), tuple(plan.workers[n].name for n in people))


def _able(plan: Plan) -> dict[int, dict[int, float]]:
    """By station: who can work there, each with the rating."""
    able: dict[int, dict[int, float]] = {rank: {} for rank in range(len(plan.stations))}
    for number, worker in enumerate(plan.workers):
        for rank in compress(range(len(worker.rating)), worker.rating):  # NOTE: workers x stations, and most are 0
            able[rank][number] = worker.rating[rank]
    return able


def _wanted(plan: Plan, flows: Flows) -> dict[int, tuple[float, float]]:
    """By station: (work of people a visit in seconds, how many of them it keeps busy)."""
    seconds: defaultdict[int, float] = defaultdict(float)
    visits: defaultdict[int, float] = defaultdict(float)
    for flow in flows.steps:
        n = flow.per_job if flows.saturated else flow.per_h
        seconds[flow.station] += n * by_hand_s(plan, flow.station, flow.product) / batch_size(plan, flow.station)
        visits[flow.station] += n
    for rank in seconds:
        setup = setup_of(plan, rank)
        if setup is not None and setup.attended:
            seconds[rank] += visits[rank] * setup_s(plan, rank, [flow for flow in flows.steps if flow.station == rank])
    return {rank: (s / visits[rank], s / 3600) for rank, s in seconds.items() if s > 0}


def by_hand_s(plan: Plan, station: int, product: int) -> float:
    """Time of people that a visit takes: of each member of a team, and of who stands by a machine."""
    tasks = [(rank, plan.tasks[rank]) for rank in plan.stations[station].tasks]
    return sum(task_s(plan, rank, product) * task.team for rank, task in tasks if task.attended or not task.automatic)


def _mean(values: Collection[float]) -> float:
    return sum(values) / len(values)
