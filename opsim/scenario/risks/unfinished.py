"""Products that are never made, never finished, or pile up."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.names import natural_key
from opsim.scenario.risks.ways import last_of
from opsim.scenario.schema import Product, Release, Scenario


def unfinished_risks(scenario: Scenario) -> Iterator[str]:
    """What no source makes, what waits for parts that do not come, what ends where nobody takes it."""
    made = _made(scenario)
    for name in sorted(scenario.products, key=natural_key):
        product = scenario.products[name]
        if made is not None and name not in made:
            yield f"{name} is never made: no source makes it, and nothing is split into it"
        for part, station in sorted((part, station) for station, parts in product.parts.items() for part in parts):
            if made is not None and part not in made and name in made:
                yield f"{name} cannot be finished: at {station} it waits for {part}, which is never made"
            yield from _too_many(name, station, part, product.parts[station][part], scenario)
        yield from _piles_up(name, product, scenario)


def _made(scenario: Scenario) -> set[str] | None:
    """The products that some source makes, or that something is split into; None where a file of orders says it."""
    sources = [scenario.release] if scenario.release is not None else list(scenario.sources.values())
    found: set[str] = set()
    for source in sources:
        some = _of_source(source, scenario)
        if some is None:
            return None
        found |= some
    todo = list(found)
    while todo:
        for pieces in scenario.products[todo.pop()].split.values():
            new = set(pieces) - found
            found |= new
            todo += new
    return found


def _of_source(source: Release, scenario: Scenario) -> set[str] | None:
    if source.products is not None:
        return set(source.products)
    if source.sequence is not None:
        return None if isinstance(source.sequence, str) else set(source.sequence)
    if source.kind == "base_stock":
        return {name for name, product in scenario.products.items() if source.store in last_of(product)}
    return None if source.kind == "schedule" else set(scenario.products)


def _too_many(name: str, station: str, part: str, pieces: int, scenario: Scenario) -> Iterator[str]:
    """More pieces at once than fit in the stores where they wait."""
    stores = [scenario.stores[point] for point in last_of(scenario.products[part]) if point in scenario.stores]
    room = sum(store.capacity or 0 for store in stores) * scenario.products[part].lot
    pieces *= scenario.products[name].lot
    if not stores or any(store.capacity is None for store in stores):
        return
    batch = scenario.stations[station].batch if station in scenario.stations else None
    if room < pieces:
        yield f"{name} cannot be finished: at {station} it takes {pieces} {part} at once, and {room} fit in store"
    elif batch is not None and room < pieces * batch.size:
        yield (
            f"{batch.size} {name} in one batch at {station} take {pieces * batch.size} {part} at once, and {room} fit "
            "in store: such a batch waits for ever; make room for more, or smaller batches"
        )


def _piles_up(name: str, product: Product, scenario: Scenario) -> Iterator[str]:
    """A product that ends in a store and is part of nothing stays there."""
    stores = [point for point in last_of(product) if point in scenario.stores]
    taken = any(name in parts for other in scenario.products.values() for parts in other.parts.values())
    if stores and not taken:
        yield f"{name} ends in {stores[0]}, from which nothing takes it: it piles up there and is never finished"
