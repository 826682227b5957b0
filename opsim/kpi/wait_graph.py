"""Who waited for what when a run ended, and whether those who wait could ever have moved again.

Who waits for what, and who has it: what can still move, and the circles of those who cannot.

Jobs that were inside when a run ended: what each was doing, or waiting for; those of a queue as one.

Which jobs have a card of a loop: those that entered it and have not left it.

What jobs on a floor have and keep from each other: rooms, servers, workers, tools, cards.

Who waits for one of these does so because there is none: an engine gives everything out at once. So a pool has nothing
free, but where the rows show it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from opsim.layout import rings
from opsim.log import (
    AFTER,
    BATCH,
    BLOCKED,
    HELD,
    JOB_KINDS,
    NO_PLACE,
    PICKUP,
    PREEMPTED,
    QUEUE,
    SETUP,
    STOCK,
    TOOL,
    WAIT,
    WORK,
    EventLog,
)
from opsim.plan import Plan
from opsim.subjects.material.figures import has_card
from opsim.subjects.material.plan import jobs_on_a_server
from opsim.subjects.stations.plan import CONVEYOR, STATION, STORE

Way = tuple[tuple[str, int], ...]
"""(pool, units) of all that is wanted together."""


@dataclass(slots=True)
class Pool:
    """Something that is had and given back: places, cards, tools, workers, or pieces that somebody still brings.

    what    : in words, such as ``a place at paint``
    free    : units that nobody has
    holders : name -> units he has and gives back once he can move on
    """

    what: str
    free: float = 0
    holders: dict[str, int] = field(default_factory=dict)

    def give_to(self, holder: str, units: int = 1) -> None:
        self.holders[holder] = self.holders.get(holder, 0) + units


def stuck(waits: Mapping[str, Collection[Way]], pools: Mapping[str, Pool]) -> set[str]:
    """Those who can never move again: the largest set in which everybody, whatever way he takes, lacks something that
    only others of the set could give back.

    waits : name -> the ways out of his waiting, any of which is enough; who is not named waits for nothing
    Source: Holt 1972, Some deadlock properties of computer systems, Computing Surveys 4(3) (reduction of a graph).
    """
    left = set(waits)
    room = {
        name: pool.free + sum(n for who, n in pool.holders.items() if who not in left) for name, pool in pools.items()
    }
    while moving := {who for who in left if any(_can_go(way, room) for way in waits[who])}:
        left -= moving
        for name, pool in pools.items():
            room[name] += sum(n for who, n in pool.holders.items() if who in moving)
    return left


def circles(
    waits: Mapping[str, Collection[Way]], pools: Mapping[str, Pool]
) -> Iterator[tuple[set[str], list[tuple[str, str]]]]:
    """Of each set that waits only for each other: the set, and the shortest circle in it as (who, pool he waits for).

    The one after him in the circle has what he waits for, and the first has what the last waits for. Circles that wait
    for nobody else come alone where there are any.
    """
    inside = stuck(waits, pools)
    wanted = {who: _lacking(who, waits, pools, inside) for who in sorted(inside)}
    graph = {who: {other for _, others in lacks for other in others} for who, lacks in wanted.items()}
    found = list(rings({who: sorted(onward) for who, onward in graph.items()}))
    closed = [ring for ring in found if all(graph[who] <= ring for who in ring)]
    for ring in closed or found:
        yield ring, _shortest(ring, wanted)


def _can_go(way: Way, room: Mapping[str, float]) -> bool:
    return all(room[pool] >= units for pool, units in way)


def _lacking(
    who: str, waits: Mapping[str, Collection[Way]], pools: Mapping[str, Pool], inside: Collection[str]
) -> list[tuple[str, list[str]]]:
    """(pool, those inside who have it) of everything that somebody waits for and cannot get."""
    found: dict[str, list[str]] = {}
    for way in waits[who]:
        for name, units in way:
            pool = pools[name]
            if pool.free + sum(n for other, n in pool.holders.items() if other not in inside) < units:
                found[name] = sorted(other for other in pool.holders if other in inside)
    return list(found.items())


def _shortest(ring: Collection[str], wanted: Mapping[str, list[tuple[str, list[str]]]]) -> list[tuple[str, str]]:
    """The shortest circle through the ring, found from each of it in turn; the first of the shortest."""
    found = [circle for start in sorted(ring) if (circle := _back_to(start, wanted)) is not None]
    return min(found, key=len)


def _back_to(start: str, wanted: Mapping[str, list[tuple[str, list[str]]]]) -> list[tuple[str, str]] | None:
    """The shortest way from somebody along what is waited for back to himself."""
    came: dict[str, tuple[str, str]] = {}
    ahead = deque([start])
    while ahead:
        who = ahead.popleft()
        for pool, others in wanted[who]:
            for other in others:
                if other not in came:
                    came[other] = (who, pool)
                    ahead.append(other)
                if other == start:
                    return _trail(start, came)
    return None


def _trail(start: str, came: Mapping[str, tuple[str, str]]) -> list[tuple[str, str]]:
    steps = [came[start]]
    while steps[-1][0] != start:
        steps.append(came[steps[-1][0]])
    return steps[::-1]


SEATED = (WORK, SETUP, BLOCKED, HELD)


@dataclass(frozen=True, slots=True)
class Inside:
    """A job, or n alike ones in one queue, of which this is the one that waits longest.

    name : sorts by station, then by job; operation : that it is at, or wants next; task : that it waits with, or -1
    """

    name: str
    job: int
    n: int
    product: int
    station: int
    operation: str
    kind: int
    cause: int
    task: int
    since_s: float

    @property
    def seated(self) -> bool:
        """Whether it is on a server."""
        return self.kind in SEATED

    def waits(self, kind: int, *causes: int) -> bool:
        """Whether it is in a state for one of some causes."""
        return self.kind == kind and self.cause in causes

    def words(self, plan: Plan) -> str:
        """``job 12 (bike) at assemble``, ``3 wheels in rack``."""
        product, place = plan.products[self.product].name, plan.stations[self.station].name
        if self.waits(QUEUE, STOCK):
            return f"{self.n} of {product} in {place}"
        many = f" and {self.n - 1} more" if self.n > 1 else ""
        queue = {AFTER: "after", BATCH: "in front of", PREEMPTED: "off the server at"}.get(self.cause, "in front of")
        return f"job {self.job} ({product}{many}) {queue if self.kind == QUEUE else 'at'} {place}"


def inside_at_end(log: EventLog, plan: Plan) -> list[Inside]:
    """Who is at a point of the flow when the run ends, by station; who is still outside is not told."""
    of_jobs = np.isin(log["kind"], JOB_KINDS) & (log["job"] >= 0) & (log["station"] >= 0)
    rows = np.flatnonzero(of_jobs & (log["end_s"] == log.horizon_s))
    found: dict[tuple, Inside] = {}
    for one in _each(log, plan, rows):
        key = (one.station, one.kind, one.cause, one.product, one.operation, -1 if one.kind == QUEUE else one.job)
        before = found.get(key)
        found[key] = one if before is None else _together(before, one)
    return sorted(found.values(), key=lambda one: one.name)


def _each(log: EventLog, plan: Plan, rows: np.ndarray) -> Iterator[Inside]:
    operations = dict(enumerate(log.names["operation"]))
    columns = ("job", "product", "station", "operation", "kind", "cause", "task", "start_s")
    for job, product, station, operation, kind, cause, task, start_s in zip(*(log[c][rows].tolist() for c in columns)):
        name = f"{station:06d} {job:012d}"
        yield Inside(name, job, 1, product, station, operations.get(operation, ""), kind, cause, task, start_s)


def _together(one: Inside, other: Inside) -> Inside:
    first = min(one, other, key=lambda each: (each.since_s, each.job))
    n = one.n + other.n
    return Inside(first.name, first.job, n, *(getattr(first, field) for field in Inside.__slots__[3:]))


def card_holders(log: EventLog, plan: Plan, jobs: list[int]) -> list[set[int]]:
    """Of each loop the jobs that had a card of it when the run ended, among those that were inside then."""
    if not plan.cards:
        return []
    rows = np.flatnonzero(np.isin(log["kind"], JOB_KINDS) & (log["station"] >= 0) & np.isin(log["job"], jobs))
    rows = rows[np.lexsort([log["end_s"][rows], log["job"][rows]])]
    ways: dict[int, list[int]] = {}
    products: dict[int, int] = {}
    for job, product, station in zip(*(log[column][rows].tolist() for column in ("job", "product", "station"))):
        ways.setdefault(job, []).append(station)
        products[job] = product
    return [{job for job, way in ways.items() if has_card(card, products[job], plan, way)[-1]} for card in plan.cards]


def pools_of(log: EventLog, plan: Plan, inside: Sequence[Inside]) -> dict[str, Pool]:
    """All pools by name: ``room 3``, ``server 3``, ``after 3``, ``leader 3``, ``hands 3``, ``tool 0``, ``card 0``."""
    pools: dict[str, Pool] = {}
    for rank in range(len(plan.stations)):
        pools |= _of_point(plan, rank, inside)
    _keep_reserved(pools, plan, inside)
    pools |= _hands(log, plan, inside) | _tools(log, plan, inside) | _cards(log, plan, inside)
    return pools


def _of_point(plan: Plan, rank: int, inside: Sequence[Inside]) -> dict[str, Pool]:
    place = plan.stations[rank]
    here = [one for one in inside if one.station == rank]
    within = [one for one in here if not one.waits(QUEUE, AFTER, PICKUP)]
    seated = [one for one in here if one.seated]
    leaders = [one for one in seated if not one.waits(HELD, BATCH)]
    after = [one for one in here if one.waits(QUEUE, AFTER, PICKUP)]
    if place.kind == CONVEYOR:
        leaders = [one for one in here if one.kind == BLOCKED]
    shared = jobs_on_a_server(plan, rank) > 1 or place.kind == CONVEYOR
    room = 0.0 if shared else max(0.0, place.capacity - sum(one.n for one in within))
    servers = 0 if shared or place.kind == STORE else max(0, place.servers - len(seated))
    if shared and not leaders:
        servers = 1
    where = (
        f"in {place.name}"
        if place.kind == STORE
        else f"on {place.name}"
        if place.kind == CONVEYOR
        else f"at {place.name}"
    )
    return {
        f"room {rank}": _pool(f"a place {where}", room, within),
        f"server {rank}": _pool(
            f"a server of {place.name}" if place.kind == STATION else f"the end of {place.name}", servers, leaders
        ),
        f"after {rank}": _pool(
            f"a place in the buffer after {place.name}", place.buffer_after - sum(one.n for one in after), after
        ),
        f"leader {rank}": _pool(f"its batch at {place.name}", 0 if leaders else 1, leaders),
    }


def _pool(what: str, free: float, holders: Sequence[Inside]) -> Pool:
    return Pool(what, max(free, 0), {one.name: 1 for one in holders})


def _keep_reserved(pools: dict[str, Pool], plan: Plan, inside: Sequence[Inside]) -> None:
    """Places that are kept for jobs which are still where they come from."""
    for one in inside:
        first = plan.stations[one.station].place_first and one.seated and not one.waits(HELD, NO_PLACE)
        if first or one.cause == PICKUP:
            for rank in _ahead(plan, one) if first and one.kind != BLOCKED else wanted(plan, one.operation):
                pool = pools[f"room {rank}"]
                pool.free = max(0, pool.free - 1)
                pool.give_to(one.name)


def wanted(plan: Plan, operation: str) -> tuple[int, ...]:
    """The stations of an operation."""
    steps = (step for product in plan.products for step in product.route)
    return next(step.stations for step in steps if step.name == operation)


def _ahead(plan: Plan, one: Inside) -> tuple[int, ...]:
    """The stations of the next operation, where there is one and no other."""
    steps = next_steps(plan, one)
    return plan.products[one.product].route[steps[0]].stations if len(steps) == 1 else ()


def next_steps(plan: Plan, one: Inside) -> list[int]:
    """The steps that a job may go to from the operation it is at; -1 for the way out is not among them."""
    product = plan.products[one.product]
    here = (ways for step, ways in zip(product.route, product.onward) if step.name == one.operation)
    return sorted({to for ways in here for _, to in ways if to >= 0})


def _hands(log: EventLog, plan: Plan, inside: Sequence[Inside]) -> dict[str, Pool]:
    """Of each station those who can work there; who stands by a job of the floor is held by it.

    Who stands idle beside a job that waits is too few for its team, and not counted; who walks may be on his way.
    """
    by_job = {one.job: one.name for one in inside}
    rows = np.flatnonzero((log["kind"] == WAIT) & (log["end_s"] == log.horizon_s) & (log["job"] >= 0))
    held = {w: by_job[job] for w, job in zip(log["worker"][rows].tolist(), log["job"][rows].tolist()) if job in by_job}
    stands = (log["kind"] == WAIT) & (log["end_s"] == log.horizon_s) & (plan.idle != "patrol")
    idle = set(log["worker"][stands].tolist()) - held.keys()
    pools = {}
    for rank, place in enumerate(plan.stations):
        able = [worker for worker, who in enumerate(plan.workers) if place.kind == STATION and who.rating[rank] > 0]
        in_teams = any(plan.tasks[task].team > 1 for task in place.tasks)
        names = " or ".join(plan.workers[worker].name for worker in able)
        pool = pools[f"hands {rank}"] = Pool(
            names or "a worker", sum(not (worker in held or (in_teams and worker in idle)) for worker in able)
        )
        for worker in able:
            if worker in held:
                pool.give_to(held[worker])
        if not able:
            pool.free = 1  # nobody will ever come: no circle of jobs, and told elsewhere
    return pools


def _tools(log: EventLog, plan: Plan, inside: Sequence[Inside]) -> dict[str, Pool]:
    by_job = {one.job: one.name for one in inside}
    rows = np.flatnonzero((log["kind"] == TOOL) & (log["end_s"] == log.horizon_s))
    pools = {f"tool {rank}": Pool(f"a {tool.name}", tool.n) for rank, tool in enumerate(plan.tools)}
    for tool, job in zip(log["k"][rows].tolist(), log["job"][rows].tolist()):
        pools[f"tool {tool}"].free -= 1
        if job in by_job:
            pools[f"tool {tool}"].give_to(by_job[job])
    return pools


def _cards(log: EventLog, plan: Plan, inside: Sequence[Inside]) -> dict[str, Pool]:
    holders = card_holders(log, plan, [one.job for one in inside])
    pools = {f"card {rank}": Pool(f"a card of {card.name}") for rank, card in enumerate(plan.cards)}
    for rank, jobs in enumerate(holders):
        pool = pools[f"card {rank}"]
        for one in inside:
            if one.job in jobs:
                pool.give_to(one.name, one.n)
        pool.free = max(0, plan.cards[rank].n - sum(pool.holders.values()))
    return pools
