"""Stores, where products wait until they are taken as parts, and what lies in them at the start.

What jobs are split into, and the sources of the pieces, which no scenario names.

What comes together: bills of material, with stores, splits and batches in one thing for a Plan.

Loops of cards: where each product takes one, and where it is given back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from opsim.plan.ranks import Ranks
from opsim.problems import natural_key
from opsim.subjects.release.plan import INSIDE, SourcePlan
from opsim.subjects.routes.plan import ProductPlan
from opsim.subjects.stations.plan import BatchPlan, plan_batches

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario

Pieces = tuple[tuple[int, int], ...]
"""(product rank, number), in natural order."""


@dataclass(frozen=True, slots=True)
class StorePlan:
    """station : its rank; initial : jobs of each product there at the start; source : of those jobs, -1 without any."""

    station: int
    source: int
    initial: Pieces


def plan_stores(scenario: Scenario, ranks: Ranks, source_ranks: dict[str, int]) -> tuple[StorePlan, ...]:
    """Stores in natural order."""
    return tuple(
        StorePlan(ranks.stations[name], source_ranks.get(_source_name(name), -1), _initial(name, scenario, ranks))
        for name in sorted(scenario.stores, key=natural_key)
    )


def stock_sources(scenario: Scenario, ranks: Ranks) -> list[SourcePlan]:
    """A source for each store where something lies at the start."""
    stocks = {name: _initial(name, scenario, ranks) for name in scenario.stores}
    return [_source(name, stock, sum(n for _, n in stock)) for name, stock in stocks.items() if stock]


def stores_of(product, stores) -> list[str]:
    """The stores of a scenario in which the way of a product ends."""
    if product.route is not None:
        return [step for step in product.route if isinstance(step, str) and step in stores]
    return sorted({name for ways in product.routing.values() for name in ways if name in stores}, key=natural_key)


def pieces_of(by_product: dict[str, int], ranks: Ranks) -> Pieces:
    """Numbers of products by rank."""
    return tuple(sorted((ranks.products[product], n) for product, n in by_product.items() if n))


def _source_name(store: str) -> str:
    return f"stock: {store}"


def _source(store: str, stock: Pieces, total: int) -> SourcePlan:
    return SourcePlan(_source_name(store), INSIDE, 0.0, "wait", tuple((rank, n / total) for rank, n in stock))


def _initial(name: str, scenario: Scenario, ranks: Ranks) -> Pieces:
    """What lies in a store at the start; a number alone is of the one product that ends there."""
    from opsim.subjects.material.words import ONLY

    ends = [product for product, made in scenario.products.items() if name in stores_of(made, scenario.stores)]
    said = scenario.stores[name].initial
    return pieces_of(dict.fromkeys(ends[:1], said[ONLY]) if ONLY in said else said, ranks)


Most = dict[tuple[str, int], tuple[str, int]]
"""By source and product of a piece: the source of those pieces, and the most of them that one job becomes."""


@dataclass(frozen=True, slots=True)
class SplitPlan:
    """What a unit of a product becomes after its last task at a station.

    sources : (source of the job, product of a piece, source of the pieces, most of them a job), so that the i-th piece
              of the n-th job of a source has the number n x most + i in the source of the pieces, whatever came before
    """

    product: int
    station: int
    pieces: Pieces
    sources: tuple[tuple[int, int, int, int], ...]


def split_sources(scenario: Scenario, ranks: Ranks, sources: list[SourcePlan]) -> tuple[list[SourcePlan], Most]:
    """A source for each product that jobs of a source are split into, and for what these are split into again."""
    products = {rank: scenario.products[name] for name, rank in ranks.products.items()}
    made: dict[str, SourcePlan] = {}
    most: Most = {}
    todo = list(sources)
    while todo:
        source = todo.pop()
        for rank, n_jobs in _jobs_of_pieces(source, products, ranks):
            name = f"{source.name} > {list(ranks.products)[rank]}"
            most[source.name, rank] = name, max(n_jobs, most.get((source.name, rank), (name, 0))[1])
            if name not in made:
                made[name] = SourcePlan(name, INSIDE, 0.0, "wait", ((rank, 1.0),))
                todo.append(made[name])
    return list(made.values()), most


def plan_splits(scenario: Scenario, ranks: Ranks, source_ranks: dict[str, int], most: Most) -> tuple[SplitPlan, ...]:
    """Splits in natural order of products and stations."""
    return tuple(
        SplitPlan(rank, ranks.stations[station], pieces, _sources_of(pieces, source_ranks, most))
        for product, rank in ranks.products.items()
        for station, said in sorted(scenario.products[product].split.items(), key=lambda item: natural_key(item[0]))
        for pieces in [pieces_of(said, ranks)]
    )


def _jobs_of_pieces(source: SourcePlan, products, ranks: Ranks):
    """(product, jobs) of what a job of a source may become: pieces in lots of their product, the last one smaller."""
    for rank, _ in source.mix:
        for pieces in products[rank].split.values():
            for name, n in pieces.items():
                piece = ranks.products[name]
                yield piece, -(-n * products[rank].lot // products[piece].lot)


def _sources_of(pieces: Pieces, ranks: dict[str, int], most: Most) -> tuple[tuple[int, int, int, int], ...]:
    wanted = {product for product, _ in pieces}
    found = ((ranks[source], product, ranks[name], n) for (source, product), (name, n) in most.items())
    return tuple(sorted(one for one in found if one[1] in wanted))


@dataclass(frozen=True, slots=True)
class KitPlan:
    """What a unit of a product takes from stores at a station: all at once, before its first task there."""

    product: int
    station: int
    parts: Pieces


@dataclass(frozen=True, slots=True)
class Assembly:
    """All of it, and the sources that a scenario names with those that it makes necessary."""

    sources: tuple[SourcePlan, ...]
    stores: tuple[StorePlan, ...]
    kits: tuple[KitPlan, ...]
    splits: tuple[SplitPlan, ...]
    batches: tuple[BatchPlan, ...]


def plan_assembly(scenario: Scenario, ranks: Ranks, sources: tuple[SourcePlan, ...]) -> Assembly:
    """``sources`` are those that the scenario names: they come first, then the others in natural order."""
    known = [*sources, *stock_sources(scenario, ranks)]
    pieces, most = split_sources(scenario, ranks, known)
    made = sorted([*known[len(sources) :], *pieces], key=lambda source: natural_key(source.name))
    ordered = (*sources, *made)
    source_ranks = {source.name: rank for rank, source in enumerate(ordered)}
    return Assembly(
        ordered,
        plan_stores(scenario, ranks, source_ranks),
        _kits(scenario, ranks),
        plan_splits(scenario, ranks, source_ranks, most),
        plan_batches(scenario, ranks),
    )


def _kits(scenario: Scenario, ranks: Ranks) -> tuple[KitPlan, ...]:
    return tuple(
        KitPlan(rank, ranks.stations[station], pieces_of(parts, ranks))
        for product, rank in ranks.products.items()
        for station, parts in sorted(scenario.products[product].parts.items(), key=lambda item: natural_key(item[0]))
    )


def jobs_on_a_server(plan, station: int) -> int:
    """The most jobs that share one server of a station: those of a batch, and the pieces that each of them becomes."""
    batch = next((batch.size for batch in plan.batches if batch.station == station), 1)
    pieces = [_most_pieces(split) for split in plan.splits if split.station == station]
    return batch * max(pieces, default=1)


def _most_pieces(split: SplitPlan) -> int:
    by_source: dict[int, int] = {}
    for source, _product, _of_pieces, most in split.sources:
        by_source[source] = by_source.get(source, 0) + most
    return max(by_source.values(), default=1)


@dataclass(frozen=True, slots=True)
class CardPlan:
    """n cards, one for each job between two points.

    steps : (P,) of each product the steps of its route before which it takes one; empty where it needs none
    back  : ranks of the points at whose leaving it is given back; empty: on the way out
    """

    name: str
    n: int
    steps: tuple[tuple[int, ...], ...]
    back: tuple[int, ...]


def plan_cards(
    scenario: Scenario, ranks: Ranks, products: tuple[ProductPlan, ...], sources: tuple[SourcePlan, ...]
) -> tuple[CardPlan, ...]:
    """All loops in natural order of names.

    Products that no source makes, such as the pieces of a split, come from inside: of a loop that begins at the first
    station they need a card only where it names them.
    """
    released = {products[rank].name for source in sources if source.kind != INSIDE for rank, _ in source.mix}
    return tuple(
        _card(name, card, ranks, products, released)
        for name, card in sorted(scenario.cards.items(), key=lambda item: natural_key(item[0]))
    )


def _card(name: str, card: Any, ranks: Ranks, products: tuple[ProductPlan, ...], released: set[str]) -> CardPlan:
    begin, end = ({ranks.stations[point] for point in points or ()} for points in (card.begin, card.end))
    asked = card.products or (released if card.begin is None else set(ranks.products))
    steps = tuple(_steps(product, begin, end) if product.name in asked else () for product in products)
    return CardPlan(name, card.n, steps, tuple(sorted(end)))


def _steps(product: ProductPlan, begin: set[int], end: set[int]) -> tuple[int, ...]:
    """The steps before which a product takes a card: those from which a way leads to where it is given back."""
    if begin:
        first = [step for step, operation in enumerate(product.route) if begin.intersection(operation.stations)]
    else:
        first = sorted({step for _, step in product.start})
    return tuple(step for step in first if not end or _leads_to(product, step, end))


def _leads_to(product: ProductPlan, step: int, end: set[int]) -> bool:
    """Whether a way leads from a step of a product, or that step itself is, one of some points."""
    seen, todo = {step}, [step]
    while todo:
        here = todo.pop()
        if end.intersection(product.route[here].stations):
            return True
        onward = {other for _, other in product.onward[here] if other >= 0} - seen
        seen |= onward
        todo += onward
    return False
