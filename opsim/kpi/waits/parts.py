"""Parts that jobs wait for: who could still bring them, and who could take what lies in a store.

Something comes to a point where a job of its product can go on, or one that is split into it, or its source makes one,
and its way there is free: at each station of it a server that somebody could leave. So parts come from those on their
way to a store, and stock is taken by those on their way to a station where it goes in, and by those who wait there.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from opsim.kpi.waits.bringing import NOBODY, add_sources, bringing, cards_before
from opsim.kpi.waits.fills import TO_FILL, endless, fillers, filling, spaces_of
from opsim.kpi.waits.graph import Pool, Way
from opsim.kpi.waits.inside import Inside
from opsim.log import BATCH, HELD, NO_PARTS, QUEUE, STOCK
from opsim.plan import Plan
from opsim.plan.station import STORE

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
