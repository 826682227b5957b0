"""Workers who stay with a blocked job, all of them, in front of something full that waits for one of them.

Who may wait for whom: every resource of a scenario that jobs hold while they wait for another one.

A node of the graph is a resource or a phase of jobs that hold some; an edge says that the first is free again only
when the second moves on, and why. Nodes: the room at a point (``press``), its jobs by what they wait for next
(``press/place``, ``/parts``, ``/tools``, ``/work``, ``/done``), ``card loop``, ``tool gun``, ``part wheel`` (that it
comes), ``stock wheel`` (that it is taken).
Source: Coffman, Elphick & Shoshani 1971, System deadlocks, Computing Surveys 3(2).

Rings of jobs that may wait for each other for ever, over rooms, parts, tools and cards.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from itertools import chain, pairwise, permutations
from math import gcd, inf

from opsim.layout import reached, reverse, rings
from opsim.problems import enumerated, natural_key
from opsim.scenario.schema import Product, Scenario
from opsim.scenario.warnings.routes import (
    Ways,
    between,
    finite,
    first_of,
    keeps_place,
    last_of,
    needs_card,
    points_of,
    way_of,
    ways,
)
from opsim.subjects.people.words import Rotation


def held_risks(scenario: Scenario) -> Iterator[str]:
    """Everybody who can work at a station may be held in front of points that are full because nobody works there."""
    held = scenario.allocation.when_blocked == "held"
    why, remedy = ("when_blocked: held", "'when_blocked: free'") if held else ("carried: true", "'carried: false'")
    onward, stays = ways(scenario), ways(scenario, only_carried=not held)
    if not stays:
        return
    people, stuck = _people(scenario), _stuck(scenario, onward, stays)
    full = stuck & _limited(scenario)
    back, passed = reverse(onward | _takers(scenario)), full - {*people}
    for name in sorted(stuck.intersection(people), key=natural_key):
        ahead = reached(back, [name], without={*onward} - passed) & full
        near = _holders(name, people, ahead, stays, scenario)
        before = near or _holders(name, people, full, stays, scenario)
        if before and any(ahead & stays.get(one, set()) for one in people.keys() - {name}):
            who, where = (enumerated(sorted(names, key=natural_key)) for names in (people[name], before))
            who = f"those of {who} whose post it is" if _rotations(name, scenario) else who
            waits = f"{name} is full and" if name in full else f"work at {name}"
            yield (
                f"with {why}, {who} can all be held at {where} while {waits} waits for one of them: then nothing moves "
                f"any more; take {remedy}, or let somebody work at {name} alone"
            )


def _stuck(scenario: Scenario, onward: Ways, stays: Ways) -> set[str]:
    """The largest set of points that can all wait for each other: a point's jobs wait for a full one, its people are
    all held in front of full ones, or nobody takes anything from it.
    """
    people, limited, takers = _people(scenario), _limited(scenario), _takers(scenario)
    stuck = {*scenario.stations, *scenario.conveyors, *scenario.stores}
    while True:
        full = stuck & limited
        left = {
            name
            for name in stuck
            if onward.get(name, set()) & (full - {name})
            or takers.get(name, set()) & stuck
            or (name in people and _holders(name, people, full, stays, scenario))
        }
        if left == stuck:
            return stuck
        stuck = left


def _holders(name: str, people: Ways, full: set[str], stays: Ways, scenario: Scenario) -> set[str]:
    """The stations where all who can work at a station may be held in front of full points; empty where they cannot."""
    able = people[name]
    before = {one for one, who in people.items() if who & able and stays.get(one, set()) & (full - {one})}
    places = sum(scenario.stations[one].servers + scenario.stations[one].buffer_after for one in before)
    held = able.intersection(set().union(*(people[one] for one in before)))
    team = max((scenario.tasks[task].team for task in scenario.stations[name].tasks), default=1)
    return before if min(len(held), places) > _at_once(name, able, scenario) - team else set()


def _at_once(name: str, able: set[str], scenario: Scenario) -> int:
    """How many of those who can work at a station may work there at the same time, at least."""
    return len(able) - sum(max(0, len(able.intersection(one.workers)) - 1) for one in _rotations(name, scenario))


def _rotations(name: str, scenario: Scenario) -> list[Rotation]:
    """Those that may leave a station to one member for good; by the clock another one has his turn in time."""
    turning = [one for one in scenario.rotations.values() if one.every_s is None]
    return [one for one in turning if any(name in post for post in one.posts)]


def _limited(scenario: Scenario) -> set[str]:
    """The points that can be full."""
    stations = {name for name, station in scenario.stations.items() if station.buffer is not None}
    stations |= {name for line in scenario.lines.values() for name in line.stations}
    return stations | {*scenario.conveyors} | {n for n, s in scenario.stores.items() if (s.capacity or inf) < inf}


def _takers(scenario: Scenario) -> Ways:
    """Of each store, the stations that take parts from it."""
    takers: Ways = {}
    for made in scenario.products.values():
        for station, parts in made.parts.items():
            for store in (store for part in parts for store in points_of(scenario.products[part])):
                if store in scenario.stores:
                    takers.setdefault(store, set()).add(station)
    return takers


def _people(scenario: Scenario) -> Ways:
    """Who works at each station; no station where everything is automatic, or of a crew, whose people go with jobs."""
    by_hand = {task for task, block in scenario.tasks.items() if block.automatic is not True}
    manned = {name for name, station in scenario.stations.items() if not by_hand.isdisjoint(station.tasks)}
    manned -= {station for crew in scenario.crews.values() for station in crew.stations}
    able: Ways = {}
    for name, worker in scenario.workers.items():
        serves = manned.intersection(worker.skills)
        if scenario.allocation.idle == "patrol":
            serves &= set(worker.patrol or ())
        for station in serves:
            able.setdefault(station, set()).add(name)
    return able


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


MOST_STEPS = 20_000
"""Of a search: a ring that takes longer to find is not told."""


def lock_risks(scenario: Scenario) -> Iterator[str]:
    """Rings of finite buffers, each said once, then one ring for each tool, card, part or store that is in one."""
    yield from _rings_of_room(scenario)
    yield from _rings_of_resources(scenario)


def _rings_of_room(scenario: Scenario) -> Iterator[str]:
    """Points that pass jobs round, each with finite room: all may be full, and each wait for the next."""
    onward, limited = ways(scenario), finite(scenario)
    graph = {name: onward.get(name, set()) & limited for name in limited}
    for names in sorted(sorted(ring, key=natural_key) for ring in rings(graph)):
        if len(names) > 1:  # a job that comes back to its own station keeps its place there
            before = " (a place is kept before they begin)" if any(keeps_place(scenario, n) for n in names) else ""
            yield (
                f"{enumerated(names)} send jobs round in a circle through buffers with limits{before}: when all are "
                f"full, nothing moves any more; give one of them 'buffer: unlimited'"
            )


def _rings_of_resources(scenario: Scenario) -> Iterator[str]:
    """Of points and resources that hang together the first ring, and how many more there are."""
    if not (scenario.tools or scenario.cards or scenario.stores):
        return
    graph, never = waits_of(scenario), never_together(scenario)
    for ring in sorted(rings(graph), key=lambda ring: natural_key(min(ring, key=natural_key))):
        inside = {name: {other: why for other, why in graph[name].items() if other in ring} for name in ring}
        found = list(_ways_round(inside, never))
        if found:
            why = ", ".join(dict.fromkeys(inside[a][b] for a, b in pairwise(found[0]) if inside[a][b]))
            others = len(found) - 1
            more = f" ({others} more ring{'' if others == 1 else 's'} like it)" if others else ""
            yield f"jobs may wait for each other for ever: {why}{more}; {_remedy(found[0], scenario)}"


def _ways_round(graph: Waits, never: dict[str, str]) -> Iterator[list[str]]:
    """A ring through each resource that is in none of those before."""
    told: set[str] = set()
    for start in sorted((name for name in graph if _is_resource(name)), key=natural_key):
        way = None if start in told else _way_round(start, graph, never)
        if way is not None:
            told.update(way)
            yield way


def _is_resource(node: str) -> bool:
    return node.startswith(("tool ", "card ", "part "))


def _remedy(way: list[str], scenario: Scenario) -> str:
    """More of anything in the ring takes the risk away, or makes it smaller."""
    kinds = {node.partition(" ")[0] for node in way if _is_resource(node)}
    more = [word for kind, word in (("tool", "tools"), ("card", "cards"), ("part", "stock of parts")) if kind in kinds]
    rooms = sorted((node for node in way if node in scenario.stations), key=natural_key)
    room = [f"'buffer: unlimited' at {rooms[0]}"] if rooms else []
    return f"more {' or '.join(more)} helps" + (f", or {room[0]}" if room else "")


def _way_round(start: str, graph: Waits, never: dict[str, str]) -> list[str] | None:
    """The shortest way from a node back to it; None where there is none. Some nodes never stand together in a ring."""
    first = (start, frozenset({never[start]} if start in never else ()))
    before: dict[tuple[str, frozenset[str]], tuple[str, frozenset[str]] | None] = {first: None}
    todo = deque([first])
    while todo and len(before) < MOST_STEPS:
        state = todo.popleft()
        name, banned = state
        for other in sorted(graph[name], key=natural_key):
            if other == start:
                return [*_back(state, before), start]
            onward = (other, banned | {never[other]}) if other in never else (other, banned)
            if other not in banned and onward not in before:
                before[onward] = state
                todo.append(onward)
    return None


def _back(state, before) -> list[str]:
    """The nodes on the way to a state."""
    way = []
    while state is not None:
        way.append(state[0])
        state = before[state]
    return way[::-1]
