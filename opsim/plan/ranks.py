"""Names become numbers: each at its natural rank."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from opsim.problems import natural_key

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


def ranked(names: Iterable[str]) -> dict[str, int]:
    """Names in natural order, each with its number."""
    return {name: rank for rank, name in enumerate(sorted(names, key=natural_key))}


@dataclass(frozen=True, slots=True)
class Ranks:
    """The number of each name of a scenario.

    stations : of all points of the flow, which share one list: stations, stores and conveyors
    """

    places: dict[str, int]
    tasks: dict[str, int]
    stations: dict[str, int]
    products: dict[str, int]


def ranks_of(scenario: Scenario, tasks: Iterable[str]) -> Ranks:
    """The ranks of a scenario's names; ``tasks`` are those of the Plan, which has some that no scenario names."""
    points = (*scenario.stations, *getattr(scenario, "stores", ()), *getattr(scenario, "conveyors", ()))
    return Ranks(ranked(scenario.layout.places), ranked(tasks), ranked(points), ranked(scenario.products))
