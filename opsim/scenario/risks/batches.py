"""Batches that may never fill: too little room, or too few cards, for the jobs of every kind that wait for others."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.names import natural_key
from opsim.scenario.risks.ways import between, first_of, last_of, points_of, way_of, ways
from opsim.scenario.schema import Scenario, Station


def batch_risks(scenario: Scenario) -> Iterator[str]:
    """Stations where jobs of each kind may all be one short of a batch, or that those on a server come back to."""
    yield from _back_at_once(scenario)
    for name in sorted(scenario.stations, key=natural_key):
        station = scenario.stations[name]
        if station.batch is None or station.batch.most_wait_s is not None:
            continue
        most = _kinds(name, station, scenario) * (station.batch.size - 1)
        remedy = "give the batch a 'most_wait'"
        if station.buffer is not None and station.buffer <= most and most >= station.batch.size:
            yield (
                f"{name} may fill up with jobs of different kinds, up to {most} of them, none of which is a batch of "
                f"{station.batch.size}: then nothing moves any more; {remedy}, or more room"
            )
        for card in sorted(scenario.cards, key=natural_key):
            if scenario.cards[card].n <= most and _inside(name, card, scenario):
                yield (
                    f"{scenario.cards[card].n} cards of {card} may all wait at {name} for a batch of "
                    f"{station.batch.size} that never fills; {remedy}, or more cards"
                )


def _back_at_once(scenario: Scenario) -> Iterator[str]:
    """Who shares a server cannot keep its place for the next visit: it needs one in the buffer."""
    onward = ways(scenario)
    for name in sorted(scenario.stations, key=natural_key):
        station = scenario.stations[name]
        shared = station.batch is not None or any(name in made.split for made in scenario.products.values())
        if shared and station.buffer is not None and name in onward.get(name, ()):
            yield (
                f"jobs that share a server of {name} come back to it at once: when its buffer is full, nothing moves "
                "any more; give it 'buffer: unlimited'"
            )


def _kinds(name: str, station: Station, scenario: Scenario) -> int:
    """How many kinds of jobs come by that do not go together in a batch."""
    assert station.batch is not None
    passing = {product for product, made in scenario.products.items() if name in points_of(made)}
    if station.batch.of == "family":
        return len({scenario.products[product].family or product for product in passing})
    return len(passing) if station.batch.of == "product" else 1


def _inside(name: str, card: str, scenario: Scenario) -> bool:
    """Whether every job that comes to a station holds a card of a loop."""
    loop = scenario.cards[card]
    passing = [product for product, made in scenario.products.items() if name in points_of(made)]
    for product in passing:
        made = scenario.products[product]
        if loop.products is not None and product not in loop.products:
            return False
        if name not in between(way_of(made, scenario), loop.begin or first_of(made), loop.end or last_of(made)):
            return False
    return bool(passing)
