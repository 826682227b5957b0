"""Where things are, how far it is from one to the other, and which places one passes on the way."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import hypot, inf
from typing import TYPE_CHECKING

from opsim.names import natural_key

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


def ways(layout: Layout) -> Ways:
    """The shortest ways between all places of a layout, in natural order of their names."""
    if layout.distance == "paths":
        return _along(layout.places, layout.path_steps)
    names = tuple(sorted(layout.places, key=natural_key))
    return Ways(names, _as_the_crow_flies(tuple(layout.places[name] for name in names), layout.distance))


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
    from opsim.scenario.schema.layout import steps_of

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
