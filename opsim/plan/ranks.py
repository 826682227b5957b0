"""Names become numbers: each at its natural rank."""

from collections.abc import Iterable
from dataclasses import dataclass

from opsim.names import natural_key


@dataclass(frozen=True, slots=True)
class Ranks:
    """The number of each name of a scenario.

    stations : of all points of the flow, which share one list: stations, stores and conveyors
    """

    places: dict[str, int]
    tasks: dict[str, int]
    stations: dict[str, int]
    products: dict[str, int]


def ranks_of(scenario, tasks: Iterable[str]) -> Ranks:
    """The ranks of a scenario's names; ``tasks`` are those of the Plan, which has some that no scenario names."""
    points = (*scenario.stations, *getattr(scenario, "stores", ()), *getattr(scenario, "conveyors", ()))
    return Ranks(ranked(scenario.layout.places), ranked(tasks), ranked(points), ranked(scenario.products))


def ranked(names: Iterable[str]) -> dict[str, int]:
    """Names in natural order, each with its number."""
    return {name: rank for rank, name in enumerate(sorted(names, key=natural_key))}
