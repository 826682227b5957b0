"""Small questions about directed graphs of names: what is reached from where, and what goes round in a circle.

A graph maps each name to the names one step on; names without an entry lead nowhere.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

Graph = Mapping[str, Collection[str]]


def reached(graph: Graph, starts: Iterable[str], *, without: Collection[str] = ()) -> set[str]:
    """The starts, and everything they lead to on ways that do not touch ``without``."""
    found = set(starts)
    todo = list(found)
    while todo:
        for other in graph.get(todo.pop(), ()):
            if other not in found and other not in without:
                found.add(other)
                todo.append(other)
    return found


def reverse(graph: Graph) -> dict[str, set[str]]:
    """The same graph with every step taken backwards."""
    back: dict[str, set[str]] = {}
    for name, onward in graph.items():
        for other in onward:
            back.setdefault(other, set()).add(name)
    return back


def rings(graph: Graph) -> Iterator[set[str]]:
    """Sets of names that all lead to each other; a name alone only where it leads to itself. Kosaraju's algorithm."""
    back = reverse(graph)
    seen: set[str] = set()
    for name in reversed(_last_first_left(graph)):
        if name not in seen:
            ring = reached(back, [name], without=seen)
            seen |= ring
            if len(ring) > 1 or name in graph.get(name, ()):
                yield ring


def _last_first_left(graph: Graph) -> list[str]:
    """The names in the order in which a walk through everything leaves them for the last time."""
    left: list[str] = []
    seen: set[str] = set()
    for start in graph:
        if start in seen:
            continue
        seen.add(start)
        trail = [(start, iter(graph[start]))]
        while trail:
            name, onward = trail[-1]
            other = next((other for other in onward if other not in seen), None)
            if other is None:
                left.append(name)
                trail.pop()
            else:
                seen.add(other)
                trail.append((other, iter(graph.get(other, ()))))
    return left
