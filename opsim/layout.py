"""Where things are, how far it is from one to the other, and which places one passes on the way.

Small questions about directed graphs of names: what is reached from where, and what goes round in a circle.

A graph maps each name to the names one step on; names without an entry lead nowhere.

Who is at which post: each post one person who can, then each a second one, until everybody has a post.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import hypot, inf
from typing import TYPE_CHECKING

from opsim.problems import natural_key

if TYPE_CHECKING:
    import numpy as np

    from opsim.scenario.schema import Layout, Path

Point = tuple[float, float]
Matrix = tuple[tuple[float, ...], ...]


@dataclass(frozen=True, slots=True)
class Ways:
    """The shortest ways between P places in natural order.

    distance_m : (P, P) metres from the first to the second, inf where no path leads
    before     : (P, P) the place before the second on the way from the first, -1 where there is none
    """

    places: tuple[str, ...]
    distance_m: Matrix
    before: tuple[tuple[int, ...], ...] | None = None

    def way(self, start: str, end: str) -> tuple[str, ...]:
        """The places passed on the shortest way, both ends included. Raises ValueError where no path leads."""
        first, last = self.places.index(start), self.places.index(end)
        if self.distance_m[first][last] == inf:
            raise ValueError(f"no path leads from {start!r} to {end!r}")
        if self.before is None or first == last:
            return (start,) if first == last else (start, end)
        passed = [last]
        while passed[-1] != first:
            passed.append(self.before[first][passed[-1]])
        return tuple(self.places[rank] for rank in reversed(passed))


def ways(layout: Layout, moved: Mapping[str, Point] | None = None) -> Ways:
    """The shortest ways between all places of a layout, in natural order of their names; ``moved`` are elsewhere."""
    places = {**layout.places, **(moved or {})}
    if layout.distance == "paths":
        return _along(places, layout.path_steps)
    names = tuple(sorted(places, key=natural_key))
    return Ways(names, _as_the_crow_flies(tuple(places[name] for name in names), layout.distance))


def distances_m(layout: Layout) -> Matrix:
    """(P, P) metres between places in natural order: straight, along the axes, or along paths (inf: none leads)."""
    return ways(layout).distance_m


@lru_cache(maxsize=8)
def _as_the_crow_flies(points: tuple[Point, ...], distance: str) -> Matrix:
    """Found once for the variants of a file, which mostly share their places."""
    # NOTE: no function a pair of places: of 500 places the matrix takes 25 ms in place of 50
    if distance == "euclidean":
        return tuple(tuple([hypot(x - u, y - v) for u, v in points]) for x, y in points)
    return tuple(tuple([abs(x - u) + abs(y - v) for u, v in points]) for x, y in points)


def road_distances_m(layout: Layout, roads: list) -> Matrix:
    """(P, P) metres between the places of a layout along given roads only (inf: none leads)."""
    from opsim.subjects.transport.words import steps_of

    return _along(layout.places, steps_of(roads)).distance_m


def _along(places: dict[str, Point], steps: list[Path]) -> Ways:
    """Dijkstra from every place; of equal ways the one by the places first in natural order."""
    from scipy.sparse.csgraph import dijkstra

    names = tuple(sorted(places, key=natural_key))
    distance, before = dijkstra(_lengths(places, steps, names), return_predecessors=True)
    return Ways(names, tuple(map(tuple, distance.tolist())), tuple(map(tuple, before.clip(min=-1).tolist())))


def _lengths(places: dict[str, Point], steps: list[Path], names: tuple[str, ...]) -> np.ndarray:
    """Sparse (P, P): the length of the shortest direct path; 0 is a length too."""
    from scipy.sparse import csr_array

    rank = {name: number for number, name in enumerate(names)}
    shortest: dict[tuple[int, int], float] = {}
    for path in steps:
        a, b = rank[path.start], rank[path.end]
        straight_m = _euclidean_m(places[path.start], places[path.end])
        length_m = straight_m if path.length_m is None else path.length_m
        for pair in [(a, b)] if path.one_way else [(a, b), (b, a)]:
            shortest[pair] = min(length_m, shortest.get(pair, inf))
    pairs = sorted(shortest)
    rows, columns = [a for a, _ in pairs], [b for _, b in pairs]
    return csr_array(([shortest[pair] for pair in pairs], (rows, columns)), shape=(len(names), len(names)))


def _euclidean_m(a: Point, b: Point) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])


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


Key = Callable[[int, int], tuple[float, ...]]


def given_out(n_posts: int, people: Sequence[int], can: Callable[[int, int], bool], key: Key) -> dict[int, int]:
    """{person: post}. Everybody who can be at one of the posts has one.

    people : numbers, in the order of their list; can(person, post) : whether he can be there
    key(person, slot) : the smallest goes first; slot n_posts + j is post j for the second time, and so on. Where there
    are more posts than people, those with the smallest keys are manned.
    No post is empty while another one is double, unless nobody who is left can be there: where only somebody who has a
    post already can, he moves, and another one takes his (augmenting ways, Kuhn 1955).
    """
    at: dict[int, int] = {}
    left, first = [person for person in people if any(can(person, post) for post in range(n_posts))], 0
    while left:
        at.update(_one_each(n_posts, left, can, key, first))
        left, first = [person for person in left if person not in at], first + n_posts
    return at


def turns_away(member: int, turn: int, slot: int, n_slots: int) -> int:
    """How many changes from now a slot is that of the n-th of those who are there, by turns; 0: it is now.

    n_slots : people who are there, or posts, whichever are more: all of them are gone through.
    """
    return (slot - member - turn) % n_slots


def _one_each(n_posts: int, left: Sequence[int], can, key: Key, first: int) -> dict[int, int]:
    """{person: post} with one person at each post, the first posts first."""
    holder: dict[int, int] = {}
    keys = [{person: key(person, first + post) for person in left if can(person, post)} for post in range(n_posts)]
    wanted = [sorted(mine, key=mine.__getitem__) for mine in keys]
    posts = [post for post in range(n_posts) if wanted[post]]
    if len(left) < n_posts:
        posts.sort(key=lambda post: keys[post][wanted[post][0]])
    for post in posts:
        _fill(post, wanted, holder, set())
    return {person: post for post, person in holder.items()}


def _fill(post: int, wanted: list[list[int]], holder: dict[int, int], asked: set[int]) -> bool:
    """Somebody is found for a post: one without a post, or one whose post somebody else takes."""
    taken = {person: other for other, person in holder.items()}
    for person in wanted[post]:
        if person not in taken:
            holder[post] = person
            return True
    for person in wanted[post]:
        other = taken[person]
        if other not in asked:
            asked.add(other)
            if _fill(other, wanted, holder, asked):
                holder[post] = person
                return True
    return False
