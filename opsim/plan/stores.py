"""Stores, where products wait until they are taken as parts, and what lies in them at the start."""

from dataclasses import dataclass

from opsim.names import natural_key
from opsim.plan.ranks import Ranks
from opsim.plan.release import INSIDE, SourcePlan

Pieces = tuple[tuple[int, int], ...]
"""(product rank, number), in natural order."""


@dataclass(frozen=True, slots=True)
class StorePlan:
    """station : its rank; initial : jobs of each product there at the start; source : of those jobs, -1 without any."""

    station: int
    source: int
    initial: Pieces


def plan_stores(scenario, ranks: Ranks, source_ranks: dict[str, int]) -> tuple[StorePlan, ...]:
    """Stores in natural order."""
    return tuple(
        StorePlan(ranks.stations[name], source_ranks.get(_source_name(name), -1), _initial(name, scenario, ranks))
        for name in sorted(scenario.stores, key=natural_key)
    )


def stock_sources(scenario, ranks: Ranks) -> list[SourcePlan]:
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


def _initial(name: str, scenario, ranks: Ranks) -> Pieces:
    """What lies in a store at the start; a number alone is of the one product that ends there."""
    from opsim.scenario.schema.assembly import ONLY

    ends = [product for product, made in scenario.products.items() if name in stores_of(made, scenario.stores)]
    said = scenario.stores[name].initial
    return pieces_of(dict.fromkeys(ends[:1], said[ONLY]) if ONLY in said else said, ranks)
