"""Who may wait for whom: every resource of a scenario that jobs hold while they wait for another one.

A node of the graph is a resource or a phase of jobs that hold some; an edge says that the first is free again only
when the second moves on, and why. Nodes: the room at a point (``press``), its jobs by what they wait for next
(``press/place``, ``/parts``, ``/tools``, ``/work``, ``/done``), ``card loop``, ``tool gun``, ``part wheel`` (that it
comes), ``stock wheel`` (that it is taken).
Source: Coffman, Elphick & Shoshani 1971, System deadlocks, Computing Surveys 3(2).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain, permutations
from math import gcd

from opsim.scenario.risks.room import finite, keeps_place, needs_card
from opsim.scenario.risks.ways import Ways, between, first_of, last_of, points_of, way_of, ways
from opsim.scenario.schema import Product, Scenario

Waits = dict[str, dict[str, str]]
"""By node, what it waits for, each with the reason in words (empty where it goes without saying)."""
Edge = tuple[str, str, str]
PHASES = ("place", "parts", "tools", "work", "done")
"""The order in which a job gets what it needs at a station: a place kept further on, parts, tools, work, a way on."""


def waits_of(scenario: Scenario) -> Waits:
    """The whole graph of a scenario."""
    graph: Waits = {}
    edges = (_phases, _room, _parts, _in_turn, _tools, _cards)
    for here, there, why in chain.from_iterable(part(scenario) for part in edges):
        if here != there:  # a job that comes back to its own station keeps its place there
            graph.setdefault(here, {}).setdefault(there, why)
    return graph


def never_together(scenario: Scenario) -> dict[str, str]:
    """Stock of a part, and waiting for it: not at once, unless one job takes more pieces than can be there.

    Of a lot that is begun some pieces may be left, and it keeps its card and its place until the last of them is taken.
    """
    pairs: dict[str, str] = {}
    for part, made in scenario.products.items():
        taken = list(_taken_at_once(part, scenario))
        ends = set(last_of(made))
        limits = [card.n for card in scenario.cards.values() if card.end and set(card.end) & ends]
        limits += [one.capacity for name, one in scenario.stores.items() if name in ends and one.capacity is not None]
        fewest_left = gcd(made.lot, *taken)
        if all(max(taken, default=0) <= (lots - 1) * made.lot + fewest_left for lots in limits):
            pairs |= {f"part {part}": f"stock {part}", f"stock {part}": f"part {part}"}
    return pairs


def _taken_at_once(part: str, scenario: Scenario) -> Iterator[int]:
    for made in scenario.products.values():
        yield from (parts[part] * made.lot for parts in made.parts.values() if part in parts)


def _phases(scenario: Scenario) -> Iterator[Edge]:
    """Who holds a place at a station may be in any phase; a conveyor has only jobs that want off it."""
    for name in scenario.stations:
        yield from ((name, f"{name}/{phase}", "") for phase in PHASES)
    yield from ((name, f"{name}/done", "") for name in scenario.conveyors)


def _later(station: str, phase: str) -> list[str]:
    """The phases of jobs that have got what they waited for in this one."""
    return [f"{station}/{later}" for later in PHASES[PHASES.index(phase) + 1 :]]


def _wanting(scenario: Scenario, point: str) -> str:
    """Jobs of a point that wait for what comes after it."""
    return f"{point}/{'place' if keeps_place(scenario, point) else 'done'}"


def _room(scenario: Scenario) -> Iterator[Edge]:
    limited = finite(scenario)
    for here, onward in ways(scenario).items():
        for there in onward & limited:
            yield _wanting(scenario, here), there, f"{here} waits for room at {there}"
            if keeps_place(scenario, here):
                for phase in _later(here, "place"):
                    yield there, phase, f"a place at {there} is kept for {here}"


def _parts(scenario: Scenario) -> Iterator[Edge]:
    """Assemblies wait for parts; parts come by their stations; a full store waits for who takes from it."""
    for made in scenario.products.values():
        for station, parts in made.parts.items():
            for part in parts:
                yield f"{station}/parts", f"part {part}", f"{station} waits for {part}"
                yield f"stock {part}", station, f"{part} waits for {station} to take it"
                for store in last_of(scenario.products[part]):
                    yield store, f"stock {part}", f"{store} is full"
                for maker in _makers(part, scenario):
                    ahead = [point for point in points_of(maker) if point not in scenario.stores]
                    yield from ((f"part {part}", point, f"{part} comes by {point}") for point in ahead)


def _in_turn(scenario: Scenario) -> Iterator[Edge]:
    """A saturated source makes its products in turn: one that may not come in yet keeps the others back."""
    for name, source in scenario.sources.items():
        made = set(source.products or (source.sequence if isinstance(source.sequence, list) else ()))
        for part, other in permutations(sorted(made) if source.kind == "saturated" else (), 2):
            why = f"{part} comes after {other} from {name}"
            yield from ((f"part {part}", f"card {card}", why) for card in _cards_at_the_start(other, scenario))
            yield from ((f"part {part}", point, why) for point in first_of(scenario.products[other]))


def _cards_at_the_start(product: str, scenario: Scenario) -> list[str]:
    first = first_of(scenario.products[product])
    loops = ((name, card) for name, card in scenario.cards.items() if needs_card(product, card))
    return [name for name, card in loops if card.begin is None or set(card.begin) & set(first)]


def _makers(part: str, scenario: Scenario) -> Iterator[Product]:
    """The product itself, and those of which it is split off."""
    todo, seen = [part], set()
    while todo:
        name = todo.pop()
        seen.add(name)
        yield scenario.products[name]
        for other, made in scenario.products.items():
            if other not in seen and any(name in pieces for pieces in made.split.values()):
                todo.append(other)


def _tools(scenario: Scenario) -> Iterator[Edge]:
    """Tools of a station are held until the job leaves it, those of a task until its end."""
    for name, station in scenario.stations.items():
        for tool in station.needs:
            yield f"{name}/tools", f"tool {tool}", f"{name} waits for {tool}"
            yield from ((f"tool {tool}", phase, f"{tool} is held at {name}") for phase in _later(name, "tools"))
        for task in (scenario.tasks[task] for task in station.tasks):
            wanted = [*task.needs, *([] if task.hold is None else [task.hold.tool])]
            for tool in wanted:
                yield f"{name}/work", f"tool {tool}", f"{name} waits for {tool}"
            if task.hold is not None:
                for tool in task.needs:
                    yield (
                        f"tool {tool}",
                        f"tool {task.hold.tool}",
                        f"{tool} is held at {name}, which waits for {task.hold.tool}",
                    )


def _cards(scenario: Scenario) -> Iterator[Edge]:
    """A card is held by jobs between its two points; who wants in before its first point waits for one."""
    for name, card in scenario.cards.items():
        for product, made in scenario.products.items():
            if needs_card(product, card):
                way = way_of(made, scenario)
                begins = [p for p in card.begin or first_of(made) if p in points_of(made)]
                inside = between(way, begins, card.end or last_of(made))
                for point in inside:
                    there = f"stock {product}" if point in scenario.stores else point
                    yield f"card {name}", there, f"cards of {name} are at {point}"
                yield from _wanting_cards(name, product, made, way, set(begins) & inside, scenario)


def _wanting_cards(
    card: str, product: str, made: Product, way: Ways, begins: Iterable[str], scenario: Scenario
) -> Iterator[Edge]:
    for begin in begins:
        for here, onward in way.items():
            if begin in onward and here != begin:
                yield _wanting(scenario, here), f"card {card}", f"{here} waits for a card of {card}"
        if begin in first_of(made):
            yield f"part {product}", f"card {card}", f"{product} waits for a card of {card}"
