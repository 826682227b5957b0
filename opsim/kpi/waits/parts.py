"""Parts that jobs wait for: who could still bring them, and who could take what lies in a store.

Something comes to a point where a job of its product can go on, or one that is split into it, or its source makes one,
and its way there is free: at each station of it a server that somebody could leave. So parts come from those on their
way to a store, and stock is taken by those on their way to a station where it goes in, and by those who wait there.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from opsim.kpi.waits.graph import Pool, Way
from opsim.kpi.waits.inside import Inside
from opsim.log import BATCH, HELD, NO_PARTS, QUEUE, STOCK
from opsim.plan import Plan
from opsim.plan.release import INSIDE
from opsim.plan.station import STORE

Waits = dict[str, tuple[Way, ...]]
END = -1
"""The end of a way: the store in which it ends, or out."""


@dataclass(frozen=True, slots=True)
class Coming:
    """Jobs of a product on their way to a station, or to the ``END`` of their way."""

    product: int
    target: int = END

    @property
    def pool(self) -> str:
        return f"coming {self.product} {self.target}"

    def passing(self, step: int) -> str:
        """The pool of a free way from a step on."""
        return f"way {self.product} {self.target} {step}"


def missing_parts(one: Inside, plan: Plan, inside: Sequence[Inside]) -> list[str]:
    """Pools of the products of which there are fewer in the stores than a job waits for at its station."""
    kits = [kit for kit in plan.kits if (kit.product, kit.station) == (one.product, one.station)]
    others = sum(other.station == one.station and other.waits(HELD, BATCH) for other in inside)
    firsts = sum(other.station == one.station and other.seated for other in inside) - others
    units = plan.products[one.product].lot * (1 + -(-others // max(firsts, 1)))
    return [Coming(part).pool for kit in kits for part, n in kit.parts if _in_stock(part, plan, inside) < n * units]


def _in_stock(part: int, plan: Plan, inside: Sequence[Inside]) -> int:
    return sum(one.n for one in inside if one.product == part and one.waits(QUEUE, STOCK)) * plan.products[part].lot


def add_parts(pools: dict[str, Pool], waits: Waits, plan: Plan, inside: Sequence[Inside]) -> dict[str, str]:
    """Add pools of what is coming, and of takers, and those who stand for them; returns these, each in words."""
    words: dict[str, str] = {}
    if not any(place.kind == STORE for place in plan.stations):
        return words
    pools |= {f"who {one.name}": Pool("the same job", 0, {one.name: 1}) for one in inside}
    wanted = _wanted(plan)
    for coming in wanted:
        name = plan.products[coming.product].name
        pools[coming.pool] = Pool(f"a {name}" if coming.target == END else f"a {name} to come and take it")
        for step in range(len(plan.products[coming.product].route)):
            pools[coming.passing(step)] = Pool(f"a way for {name}")
    for coming in wanted:
        for number, (pool, ways) in enumerate(_flows(plan, coming, inside)):
            flow = f"~{coming.pool} {number:06d}"
            waits[flow], words[flow] = ways, f"{plan.products[coming.product].name} on its way"
            pools[pool].give_to(flow)
    for product in range(len(plan.products)):
        for flow, ways in _takers(pools, plan, product, inside):
            waits[flow], words[flow] = ways, plan.products[product].name
    return words


def _takers(
    pools: dict[str, Pool], plan: Plan, part: int, inside: Sequence[Inside]
) -> Iterator[tuple[str, tuple[Way, ...]]]:
    """Add the pool of those who could take a part: who waits for parts where it goes in, and who is coming there."""
    kits = [kit for kit in plan.kits if any(part == one for one, _ in kit.parts)]
    names = " or ".join(sorted({plan.stations[kit.station].name for kit in kits}))
    pool = pools[f"taker {part}"] = Pool(f"somebody at {names or 'a station'} to take it")
    for kit in kits:
        for one in inside:
            if (one.product, one.station) == (kit.product, kit.station) and one.waits(HELD, NO_PARTS):
                pool.give_to(one.name)
        flow = f"~taker {part} {kit.product} {kit.station}"
        pool.give_to(flow)
        yield flow, (((Coming(kit.product, kit.station).pool, 1),),)


def _wanted(plan: Plan) -> list[Coming]:
    """Parts and those who take them, and all products that are split into any of these."""
    found = {Coming(part) for kit in plan.kits for part, _ in kit.parts}
    found |= {Coming(kit.product, kit.station) for kit in plan.kits}
    todo = list(found)
    while todo:
        piece = todo.pop()
        of_it = [split for split in plan.splits if any(piece.product == one for one, _ in split.pieces)]
        parents = {Coming(split.product, split.station) for split in of_it} - found
        found |= parents
        todo += parents
    return sorted(found, key=lambda coming: (coming.product, coming.target))


def _flows(plan: Plan, coming: Coming, inside: Sequence[Inside]) -> Iterator[tuple[str, tuple[Way, ...]]]:
    """(pool that it fills, ways) of all that brings a product nearer: free steps, jobs, sources, parents."""
    product, made = coming.product, plan.products[coming.product]
    steps = range(len(made.route))
    for at in steps:
        yield coming.passing(at), _passes(plan, coming, at)
    for one in inside:
        if one.product == product and not one.waits(QUEUE, STOCK):
            for at in (at for at in steps if made.route[at].name == one.operation):
                yield coming.pool, ((("who " + one.name, 1), (coming.passing(at), 1)),)
    starts: list[Way] = []
    for _, at in made.start:
        cards = tuple((f"card {rank}", 1) for rank, card in enumerate(plan.cards) if at in card.steps[product])
        starts.append(((coming.passing(at), 1), *cards))
    if any(source.kind != INSIDE and any(product == of for of, _ in source.mix) for source in plan.sources):
        yield coming.pool, tuple(starts)
    for split in plan.splits:
        if any(product == piece for piece, _ in split.pieces):
            parent = Coming(split.product, split.station).pool, 1
            yield coming.pool, tuple((parent, *start) for start in starts)


def _passes(plan: Plan, coming: Coming, at: int) -> tuple[Way, ...]:
    """The ways by which something goes on from a step: a server there, or a place in a store, and a free way after."""
    made = plan.products[coming.product]
    ways: list[Way] = []
    for rank in made.route[at].stations:
        point = f"{'room' if plan.stations[rank].kind == STORE else 'server'} {rank}", 1
        onward = {to for _, to in made.onward[at]}
        if rank == coming.target or (coming.target == END and -1 in onward):
            ways.append((point,))
        ways += [(point, (coming.passing(to), 1)) for to in sorted(onward) if to >= 0]
    return tuple(ways)
