"""How evenly work can be shared among people who cannot all do everything.

What people would have to do: by skill, and all together, where work is shared as well as it can be.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf

from opsim.plan.hours import Hours
from opsim.plan.loads.flows import Flows, batch_size, flows_of, setup_of, setup_s, task_s, tasks_at
from opsim.plan.plan import Plan

SMALLEST = 1e-12


def best_share(
    work: Mapping[int, float], able: Mapping[int, Sequence[int]], time: Sequence[float] | None = None
) -> tuple[float, tuple[int, ...]] | None:
    """The least share of everybody's time in which all work can be done, and the kinds of work that ask for it.

    work : by kind, in people; able : by kind, who can do it; time : of each person, by number, 1 where he is always
    there. The share is the largest of work(S) / time of people(S) over all sets S of kinds (Hall 1935); it is found by
    trying a share, and taking the set that shows it to be too small (Dinkelbach 1967). None where there is no work.
    """
    kinds = tuple(sorted(kind for kind in work if work[kind] > 0 and able[kind]))
    if not kinds:
        return None
    if time is None:
        time = [1.0] * (1 + max(person for kind in kinds for person in able[kind]))
    tight, share = kinds, _ratio(kinds, work, able, time)
    while True:
        more = _too_much(share * (1 + 1e-9), kinds, work, able, time)
        if not more or _ratio(more, work, able, time) <= share:
            return share, tight
        tight, share = more, _ratio(more, work, able, time)


def _ratio(
    kinds: Sequence[int], work: Mapping[int, float], able: Mapping[int, Sequence[int]], time: Sequence[float]
) -> float:
    people = {person for kind in kinds for person in able[kind]}
    return sum(work[kind] for kind in kinds) / sum(time[person] for person in sorted(people))


def _too_much(
    share: float,
    kinds: Sequence[int],
    work: Mapping[int, float],
    able: Mapping[int, Sequence[int]],
    time: Sequence[float],
) -> tuple[int, ...]:
    """Kinds whose work does not fit into a share of the time of all who can do it; empty where everything fits."""
    spare = {person: share * time[person] for kind in kinds for person in able[kind]}
    done: dict[int, dict[int, float]] = {person: {} for person in spare}
    stuck: set[int] = set()
    for kind in kinds:
        left = work[kind]
        while left > SMALLEST:
            way, seen = _way_to_spare(kind, spare, done, able)
            if way is None:
                stuck |= seen
                break
            left -= _hand_on(way, left, spare, done)
    return tuple(sorted(stuck))


def _way_to_spare(kind, spare, done, able) -> tuple[list[tuple[int, int]] | None, set[int]]:
    """[(kind, person), ...]: the person takes the kind, who gives up the next kind of the list, and the last has time.

    Also all kinds that were come by: where there is no way, nobody who can do one of them has any time left.
    """
    came: dict[int, tuple[int, int] | None] = {kind: None}
    person_from: dict[int, int] = {}
    todo = deque([kind])
    while todo:
        here = todo.popleft()
        for person in able[here]:
            if person in person_from:
                continue
            person_from[person] = here
            if spare[person] > SMALLEST:
                return _way(person, person_from, came), set(came)
            for other, share in done[person].items():
                if share > SMALLEST and other not in came:
                    came[other] = (here, person)
                    todo.append(other)
    return None, set(came)


def _way(person: int, person_from: dict[int, int], came) -> list[tuple[int, int]]:
    way = [(person_from[person], person)]
    while (before := came[way[-1][0]]) is not None:
        way.append(before)
    return way[::-1]


def _hand_on(way: list[tuple[int, int]], most: float, spare, done) -> float:
    """Each person of the way takes on as much of his kind as can be handed on to the end; returns how much."""
    amount = min(most, spare[way[-1][1]], *(done[person][other] for (_, person), (other, _) in pairwise(way)))
    for number, (kind, person) in enumerate(way):
        done[person][kind] = done[person].get(kind, 0.0) + amount
        if number + 1 < len(way):
            done[person][way[number + 1][0]] -= amount
    spare[way[-1][1]] -= amount
    return amount


@dataclass(frozen=True, slots=True)
class SkillLoad:
    """A skill is the work at a station. able : how many have it; work_s : work of people a visit at rating 1;
    wanted : how many of them it keeps busy (a day's work a day), for each job an hour where the floor decides what
    comes in; load : share of their time, if they did nothing else; None where the floor decides. Walks do not count.
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


def skill_loads(plan: Plan, flows: Flows | None = None, hours: Hours | None = None) -> list[SkillLoad]:
    """Load of each skill that is needed, in natural order."""
    flows, hours = flows_of(plan) if flows is None else flows, Hours(plan) if hours is None else hours
    found = []
    for rank, (work_s, wanted) in sorted(_wanted(plan, flows).items()):
        able = sorted(hours.able(rank))
        there = sum(hours.share[worker] for worker in able)
        loads = [None, None] if flows.saturated or not able else _shares(plan, hours, rank, wanted)
        found.append(SkillLoad(plan.stations[rank].name, len(able), work_s, wanted, loads[0], there, loads[1]))
    return found


def _shares(plan: Plan, hours: Hours, rank: int, wanted: float) -> list[float | None]:
    """(share of the time of the able, the same with overtime; None where there is none)."""
    able, loads = hours.able(rank), []
    for share in (hours.share, hours.share_with_overtime):
        there = sum(plan.workers[worker].rating[rank] * share[worker] for worker in sorted(able))
        loads.append(wanted / there if there > 0 else inf)
    return [loads[0], loads[1] if loads[1] < loads[0] else None]


def crew_load(plan: Plan, flows: Flows | None = None, hours: Hours | None = None) -> Crew | None:
    """The people who are worked hardest; None where nobody is needed, or nobody is ever there."""
    flows, hours = flows_of(plan) if flows is None else flows, Hours(plan) if hours is None else hours
    wanted = {rank: n for rank, (_, n) in _wanted(plan, flows).items()}
    there = {number for number, share in enumerate(hours.share) if share > 0}
    able = {rank: people for rank in wanted if (people := sorted(hours.able(rank) & there))}
    work = {rank: wanted[rank] / _mean_rating(plan, rank, people) for rank, people in able.items()}
    found = best_share(work, able, hours.share)
    if found is None:
        return None
    share, skills = found
    people = sorted({n for rank in skills for n in able[rank]})
    more = best_share(work, able, hours.share_with_overtime)
    names = tuple(plan.stations[rank].name for rank in skills)
    with_overtime = more[0] if more is not None and more[0] < share * (1 - 1e-9) else None
    return Crew(share, names, tuple(plan.workers[n].name for n in people), with_overtime)


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
    tasks = [(rank, part, plan.tasks[rank]) for rank, part in tasks_at(plan, station)]
    by_hand = [(rank, part * task.team) for rank, part, task in tasks if task.attended or not task.automatic]
    return sum(task_s(plan, rank, product) * times for rank, times in by_hand)


def _mean_rating(plan: Plan, rank: int, people: Sequence[int]) -> float:
    return sum(plan.workers[number].rating[rank] for number in people) / len(people)
