"""Rings of jobs that may wait for each other for ever, over rooms, parts, tools and cards."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from itertools import pairwise

from opsim.graph import rings
from opsim.names import natural_key
from opsim.scenario.risks.room import finite, keeps_place
from opsim.scenario.risks.waits import Waits, never_together, waits_of
from opsim.scenario.risks.ways import ways
from opsim.scenario.risks.words import listed
from opsim.scenario.schema import Scenario

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
                f"{listed(names)} send jobs round in a circle through buffers with limits{before}: when all are full, "
                f"nothing moves any more; give one of them 'buffer: unlimited'"
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
