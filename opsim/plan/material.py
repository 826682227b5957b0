"""Products and their routes."""

from dataclasses import dataclass

from opsim.names import natural_key


@dataclass(frozen=True, slots=True)
class Operation:
    """What a product needs at one step: the tasks of a station, or of one of several parallel ones."""

    name: str
    stations: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ProductPlan:
    """share : of the mix, all shares sum to 1; route : operations in order."""

    name: str
    share: float
    route: tuple[Operation, ...]


def plan_products(scenario, stations: dict[str, int]) -> tuple[ProductPlan, ...]:
    """Products in natural order; ``stations`` maps names to ranks."""
    total = sum(product.share for product in scenario.products.values())
    return tuple(
        ProductPlan(name, product.share / total, tuple(_operation(step, stations) for step in product.route))
        for name, product in sorted(scenario.products.items(), key=lambda item: natural_key(item[0]))
    )


def _operation(step, stations: dict[str, int]) -> Operation:
    names = [step] if isinstance(step, str) else sorted(step, key=natural_key)
    return Operation("|".join(names), tuple(stations[name] for name in names))
