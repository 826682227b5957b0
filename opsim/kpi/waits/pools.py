"""What jobs on a floor have and keep from each other: rooms, servers, workers, tools, cards.

Who waits for one of these does so because there is none: an engine gives everything out at once. So a pool has nothing
free, but where the rows show it.
"""

from collections.abc import Sequence

import numpy as np

from opsim.kpi.waits.cards import card_holders
from opsim.kpi.waits.graph import Pool
from opsim.kpi.waits.inside import Inside
from opsim.log import AFTER, BATCH, BLOCKED, HELD, NO_PLACE, PICKUP, QUEUE, TOOL, WAIT, EventLog
from opsim.plan import Plan
from opsim.plan.assembly import jobs_on_a_server
from opsim.plan.station import CONVEYOR, STATION, STORE


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
