"""Parts that jobs wait for: who could still bring them, and who could take what lies in a store.

Something comes to a point where a job of its product can go on, or one that is split into it, or its source makes one,
and its way there is free: at each station of it a server that somebody could leave. So parts come from those on their
way to a store, and stock is taken by those on their way to a station where it goes in, and by those who wait there.

What each job that waits could go on with: the ways out of its waiting.

Whether a floor has locked itself: jobs that wait for each other in a circle and will wait for ever.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from opsim import log as states
from opsim.kpi.material_supply import (
    NOBODY,
    TO_FILL,
    add_sources,
    bringing,
    cards_before,
    endless,
    fillers,
    filling,
    outside_at_end,
    spaces_of,
    ways_to_fill,
)
from opsim.kpi.wait_graph import Inside, Pool, Way, circles, inside_at_end, next_steps, pools_of, wanted
from opsim.log import BATCH, BLOCKED, HELD, NO_PARTS, NO_WORKER, QUEUE, STOCK, TRANSPORT, EventLog
from opsim.plan import Plan
from opsim.subjects.material.plan import jobs_on_a_server
from opsim.subjects.stations.plan import CONVEYOR, STORE

Waits = dict[str, tuple[Way, ...]]
END = -1
"""The end of a way: the store in which it ends, or out."""


@dataclass(frozen=True, slots=True)
class Coming:
    """Jobs of a product on their way to a server of a station, or to the ``END`` of their way.

    queues : to the queue of a station of batches
    """

    product: int
    target: int = END
    queues: bool = False

    @property
    def pool(self) -> str:
        return filling(self.product, self.target) if self.queues else f"coming {self.product} {self.target}"

    def passing(self, step: int) -> str:
        """The pool of a free way from a step on."""
        return f"way to {self.pool} {step}"


def missing_parts(one: Inside, plan: Plan, inside: Sequence[Inside]) -> list[str]:
    """Pools of the products of which there are fewer in the stores than a job waits for at its station.

    Where there are enough of all in whole lots, those of which one lot, begun, may be too little: rows do not tell.
    """
    kits = [kit for kit in plan.kits if (kit.product, kit.station) == (one.product, one.station)]
    others = sum(other.station == one.station and other.waits(HELD, BATCH) for other in inside)
    firsts = sum(other.station == one.station and other.seated for other in inside) - others
    units = plan.products[one.product].lot * (1 + -(-others // max(firsts, 1)))
    spare = [(part, _in_stock(part, plan, inside) - n * units) for kit in kits for part, n in kit.parts]
    missing = [part for part, left in spare if left < 0]
    begun = (part for part, left in spare if left < plan.products[part].lot - 1)
    return [Coming(part).pool for part in missing or begun]


def _in_stock(part: int, plan: Plan, inside: Sequence[Inside]) -> int:
    return sum(one.n for one in inside if one.product == part and one.waits(QUEUE, STOCK)) * plan.products[part].lot


def add_parts(
    pools: dict[str, Pool], waits: Waits, plan: Plan, inside: Sequence[Inside], outside: frozenset[int]
) -> dict[str, str]:
    """Add pools of what is coming, and of takers, and those who stand for them; returns these, each in words."""
    words: dict[str, str] = {}
    stores = any(place.kind == STORE for place in plan.stations)
    if not stores and not endless(plan):
        return words
    pools |= spaces_of(plan, inside)
    pools |= {f"who {one.name}": Pool("the same job", 0, {one.name: 1}) for one in inside}
    wanted = _wanted(plan)
    for coming in wanted:
        name = plan.products[coming.product].name
        what = f"a {name}" if coming.target == END else f"a {name} to come and take it"
        pools[coming.pool] = Pool(TO_FILL if coming.queues else what)
        for step in range(len(plan.products[coming.product].route)):
            pools[coming.passing(step)] = Pool(f"a way for {name}")
    for coming in wanted:
        for number, (pool, ways) in enumerate(_flows(plan, coming, inside, outside)):
            flow = f"~{coming.pool} {number:06d}"
            waits[flow], words[flow] = ways, f"{plan.products[coming.product].name} on its way"
            pools[pool].give_to(flow)
    for product in range(len(plan.products)):
        for flow, ways in _takers(pools, plan, product, inside):
            waits[flow], words[flow] = ways, plan.products[product].name
    return words | (add_sources(pools, waits, plan, outside) if stores else {})


def _takers(
    pools: dict[str, Pool], plan: Plan, part: int, inside: Sequence[Inside]
) -> Iterator[tuple[str, tuple[Way, ...]]]:
    """Add the pool of those who could take a part: who waits for parts where it goes in, and who is coming there."""
    kits = [kit for kit in plan.kits if any(part == one for one, _ in kit.parts)]
    names = " or ".join(sorted({plan.stations[kit.station].name for kit in kits}))
    pool = pools[f"taker {part}"] = Pool(f"somebody at {names} to take it" if names else NOBODY)
    for kit in kits:
        for one in inside:
            if (one.product, one.station) == (kit.product, kit.station) and one.waits(HELD, NO_PARTS):
                pool.give_to(one.name)
        flow = f"~taker {part} {kit.product} {kit.station}"
        pool.give_to(flow)
        yield flow, (((Coming(kit.product, kit.station).pool, 1),),)


def _wanted(plan: Plan) -> list[Coming]:
    """Parts and those who take them, who fills batches, and all products that are split into any of these."""
    found = {Coming(part) for kit in plan.kits for part, _ in kit.parts}
    found |= {Coming(kit.product, kit.station) for kit in plan.kits}
    found |= {Coming(product, batch.station, True) for batch in endless(plan) for product in fillers(plan, batch)}
    todo = list(found)
    while todo:
        piece = todo.pop()
        of_it = [split for split in plan.splits if any(piece.product == one for one, _ in split.pieces)]
        parents = {Coming(split.product, split.station) for split in of_it} - found
        found |= parents
        todo += parents
    return sorted(found, key=lambda coming: (coming.product, coming.target, coming.queues))


def _flows(
    plan: Plan, coming: Coming, inside: Sequence[Inside], outside: frozenset[int]
) -> Iterator[tuple[str, tuple[Way, ...]]]:
    """(pool that it fills, ways) of all that brings a product nearer: free steps, jobs, sources, parents."""
    product, made = coming.product, plan.products[coming.product]
    steps = range(len(made.route))
    for at in steps:
        yield coming.passing(at), _passes(plan, coming, at)
    here = [one for one in inside if coming.queues and one.station == coming.target and one.waits(QUEUE, BATCH)]
    for one in inside:
        if one.product == product and not one.waits(QUEUE, STOCK) and one not in here:
            for at in (at for at in steps if made.route[at].name == one.operation):
                yield coming.pool, ((("who " + one.name, 1), (coming.passing(at), 1)),)
    starts: list[Way] = [((coming.passing(at), 1), *cards_before(plan, product, at)) for _, at in made.start]
    for _, ways in bringing(plan, product, starts, outside):
        yield coming.pool, ways
    for split in plan.splits:
        if any(product == piece for piece, _ in split.pieces):
            parent = Coming(split.product, split.station).pool, 1
            yield coming.pool, tuple((parent, *start) for start in starts)
    for one in here:  # they wait for each other, where nobody else comes
        yield coming.pool, ((("who " + one.name, 1),),)


def _passes(plan: Plan, coming: Coming, at: int) -> tuple[Way, ...]:
    """The ways by which something goes on from a step: a server there, or a place in a store, and a free way after."""
    made = plan.products[coming.product]
    ways: list[Way] = []
    for rank in made.route[at].stations:
        point = f"{'room' if plan.stations[rank].kind == STORE else 'server'} {rank}", 1
        onward = {to for _, to in made.onward[at]}
        if rank == coming.target or (coming.target == END and -1 in onward):
            ways.append(() if coming.queues else (point,))
        ways += [(point, (coming.passing(to), 1)) for to in sorted(onward) if to >= 0]
    return tuple(ways)


def ways_of(one: Inside, plan: Plan, inside: Sequence[Inside], pools: Mapping[str, Pool]) -> tuple[Way, ...] | None:
    """The ways out; None where a job waits for nothing that other jobs have."""
    if one.kind == HELD:
        return _held(one, plan, inside, pools)
    if one.kind == BLOCKED or one.waits(QUEUE, states.AFTER):
        return _onward(one, plan, pools)
    if plan.stations[one.station].kind == CONVEYOR and one.kind in (QUEUE, TRANSPORT):
        return (((f"server {one.station}", 1),),)
    if one.waits(QUEUE, states.STOCK):
        return (((f"taker {one.product}", 1),),)
    if one.waits(QUEUE, states.BATCH):
        return ways_to_fill(one, plan, inside)
    if one.kind == QUEUE and one.cause != states.PICKUP:
        return (((f"server {one.station}", 1),),)
    return None


def _held(one: Inside, plan: Plan, inside: Sequence[Inside], pools: Mapping[str, Pool]) -> tuple[Way, ...] | None:
    if one.cause == states.NO_WORKER:
        return (((f"hands {one.station}", 1),),)
    if one.cause == states.NO_PLACE:
        return _kept(one, plan, pools)
    if one.cause == states.NO_PARTS:
        return (tuple((pool, 1) for pool in missing_parts(one, plan, inside)),)
    if one.cause == states.NO_TOOL:
        return (tuple((f"tool {tool}", n) for tool, n in _tools(one, plan)),)
    if one.cause == states.BATCH:
        return (((f"leader {one.station}", 1),),)
    return None


def _tools(one: Inside, plan: Plan) -> tuple[tuple[int, int], ...]:
    """What a job waits for: what its task needs, or holds, or else what the station needs."""
    if one.task < 0:
        return plan.stations[one.station].needs
    task = plan.tasks[one.task]
    return task.needs if task.hold is None else ((task.hold.tool, 1),)


def _kept(one: Inside, plan: Plan, pools: Mapping[str, Pool]) -> tuple[Way, ...] | None:
    """A place at the next station. Where the way is drawn, it is to none that has room: that it would have by now."""
    ways = [((f"room {rank}", 1),) for step in next_steps(plan, one) for rank in _full(plan, one, step, pools)]
    cards = [_cards(one, plan, (step,), pools) for step in next_steps(plan, one)]
    return tuple(ways) or tuple(card for card in cards if card) or None


def _full(plan: Plan, one: Inside, step: int, pools: Mapping[str, Pool]) -> tuple[int, ...]:
    """The stations of a step, where none of them has room."""
    stations = plan.products[one.product].route[step].stations
    return () if any(pools[f"room {rank}"].free for rank in stations) else stations


def _onward(one: Inside, plan: Plan, pools: Mapping[str, Pool]) -> tuple[Way, ...] | None:
    """A place at one of the stations of the operation it wants, and the cards that this takes; or a place after."""
    stations = wanted(plan, one.operation)
    lacks_card = one.cause == states.NO_CARD
    alone = one.kind == BLOCKED and jobs_on_a_server(plan, one.station) == 1
    if one.station in stations and not lacks_card and alone:
        return None  # it may always take its own place again, where it shares it with nobody
    steps = [at for at, step in enumerate(plan.products[one.product].route) if step.name == one.operation]
    cards = _cards(one, plan, steps, pools) if lacks_card else ()
    ways: tuple[Way, ...] = (cards,) if lacks_card else tuple(((f"room {rank}", 1),) for rank in stations)
    after = plan.stations[one.station].buffer_after and one.kind == BLOCKED
    return (*ways, ((f"after {one.station}", 1),)) if after else ways


def _cards(one: Inside, plan: Plan, steps: Sequence[int], pools: Mapping[str, Pool]) -> Way:
    """The cards that a job has to take before some steps, and does not have."""
    return tuple(
        (f"card {rank}", 1)
        for rank, card in enumerate(plan.cards)
        if set(steps).intersection(card.steps[one.product]) and one.name not in pools[f"card {rank}"].holders
    )


@dataclass(frozen=True, slots=True)
class Locked:
    """stations : names of the stations, stores and conveyors of those who all wait for each other, in natural order

    since_s : when the circle closed; workers : names of those who are waited for and stand by a job of it
    circle  : the shortest circle among them, who waits for what, each having what the one before waits for
    n_jobs  : how many jobs wait for each other in all
    """

    stations: tuple[str, ...]
    since_s: float
    workers: tuple[str, ...] = ()
    circle: tuple[str, ...] = field(default=(), compare=False)
    n_jobs: int = field(default=0, compare=False)


def locked(log: EventLog, plan: Plan) -> Locked | None:
    """The circle that closed first, from what was open at the horizon; None where everything could still move.

    Jobs wait for a place (those that are blocked name the operation they want), a server, a worker, tools, cards or
    parts, and what they have is free again once they can move on. A job that wants back into its own station never is
    stuck, since it may take its own place again; repairs, set-ups, transport and whatever time alone ends neither, and
    a source of a time of its own may bring more after the horizon. The stuck jobs are the largest set in which
    everybody lacks something that only others of the set have.
    Source: Coffman, Elphick & Shoshani 1971, System deadlocks, Computing Surveys 3(2) (circular wait).
    """
    inside = inside_at_end(log, plan)
    pools = pools_of(log, plan, inside)
    waits: Waits = {}
    for one in inside:
        ways = ways_of(one, plan, inside, pools)
        if ways is not None:
            waits[one.name] = ways
    words = {one.name: one.words(plan) for one in inside} | add_parts(pools, waits, plan, inside, outside_at_end(log))
    by_name = {one.name: one for one in inside}
    found = [
        _told([by_name[name] for name in sorted(ring) if name in by_name], circle, pools, words, plan)
        for ring, circle in circles(waits, pools)
        if not ring.isdisjoint(by_name)
    ]
    return min(found, key=lambda ring: (ring.since_s, ring.stations), default=None)


def _told(
    ring: Sequence[Inside],
    circle: Sequence[tuple[str, str]],
    pools: Mapping[str, Pool],
    words: Mapping[str, str],
    plan: Plan,
) -> Locked:
    """The circle as people read it."""
    short_of_hands = {one.station for one in ring if one.waits(HELD, NO_WORKER)}
    workers = tuple(w.name for w in plan.workers if any(w.rating[rank] > 0 for rank in short_of_hands))
    steps = [
        f"{words[who]} waits for {pools[pool].what}" for who, pool in circle if not pool.startswith(("who", "step"))
    ]
    return Locked(
        tuple(plan.stations[rank].name for rank in sorted({one.station for one in ring})),
        max(one.since_s for one in ring),
        workers,
        tuple(dict.fromkeys(steps)),
        sum(one.n for one in ring),
    )
