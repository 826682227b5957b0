"""What comes together: bills of material, and batches on a server; with stores and splits in one thing for a Plan."""

from dataclasses import dataclass
from math import inf

from opsim.clock import on_grid
from opsim.names import natural_key
from opsim.plan.ranks import Ranks
from opsim.plan.release import SourcePlan
from opsim.plan.splits import SplitPlan, plan_splits, split_sources
from opsim.plan.stores import Pieces, StorePlan, pieces_of, plan_stores, stock_sources


@dataclass(frozen=True, slots=True)
class KitPlan:
    """What a unit of a product takes from stores at a station: all at once, before its first task there."""

    product: int
    station: int
    parts: Pieces


@dataclass(frozen=True, slots=True)
class BatchPlan:
    """size : jobs on a server at once

    most_wait_s : after which a job goes with those there are, on the grid; inf for never
    class_of : (P,) jobs go together whose products have the same number
    """

    station: int
    size: int
    most_wait_s: float
    class_of: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Assembly:
    """All of it, and the sources that a scenario names with those that it makes necessary."""

    sources: tuple[SourcePlan, ...]
    stores: tuple[StorePlan, ...]
    kits: tuple[KitPlan, ...]
    splits: tuple[SplitPlan, ...]
    batches: tuple[BatchPlan, ...]


def plan_assembly(scenario, ranks: Ranks, sources: tuple[SourcePlan, ...]) -> Assembly:
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
        _batches(scenario, ranks),
    )


def _kits(scenario, ranks: Ranks) -> tuple[KitPlan, ...]:
    return tuple(
        KitPlan(rank, ranks.stations[station], pieces_of(parts, ranks))
        for product, rank in ranks.products.items()
        for station, parts in sorted(scenario.products[product].parts.items(), key=lambda item: natural_key(item[0]))
    )


def _batches(scenario, ranks: Ranks) -> tuple[BatchPlan, ...]:
    stations = sorted(scenario.stations, key=natural_key)
    return tuple(_batch(name, scenario, ranks) for name in stations if scenario.stations[name].batch is not None)


def _batch(name: str, scenario, ranks: Ranks) -> BatchPlan:
    batch = scenario.stations[name].batch
    classes = [_class(batch.of, product, scenario.products[product]) for product in ranks.products]
    number = {one: number for number, one in enumerate(dict.fromkeys(classes))}
    most_wait_s = inf if batch.most_wait_s is None else batch.most_wait_s and on_grid(batch.most_wait_s)
    return BatchPlan(ranks.stations[name], batch.size, most_wait_s, tuple(number[one] for one in classes))


def _class(of: str, name: str, product) -> str:
    """What goes together has the same word: all, a product, or a family (a product without one is by itself)."""
    if of == "family":
        return name if product.family is None else f"family: {product.family}"
    return name if of == "product" else ""


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
