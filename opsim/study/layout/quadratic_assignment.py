"""The quadratic assignment problem: things that people go between, put where they go least.

A plain function on arrays, for any model: flow (n, n) between things, distance (m, m) between places, m >= n.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations
from math import perm

import numpy as np

from opsim.streams import stream

MOST_ENUMERATED = 400_000
"""Ways to put things on places up to which all of them are tried: 9! = 362,880, in about a second."""
STARTS = 30
"""Of the heuristic, by far the most of them random."""


@dataclass(frozen=True, slots=True)
class Assignment:
    """``place_of[i]`` is where thing i goes; ``cost`` the sum over pairs of flow times distance."""

    place_of: tuple[int, ...]
    cost: float


@dataclass(frozen=True, slots=True)
class Assigned:
    """The cheapest assignments, no two alike. exact : all were tried, so that the first is the best there is."""

    best: tuple[Assignment, ...]
    exact: bool
    tried: int


def assigned(
    flow: np.ndarray,
    distance: np.ndarray,
    *,
    now: Sequence[int],
    fixed: Sequence[int] = (),
    allowed: Sequence[int] | None = None,
    most: int = 1,
    seed: int = 0,
    starts: int = STARTS,
) -> Assigned:
    """The ``most`` cheapest assignments found; of those with the same distances between all things, such as mirror
    images, the one that moves fewest.

    flow, distance : (n, n) and (m, m), m >= n, finite; neither needs to be symmetric
    now, fixed     : where each thing is, and the things that stay there
    allowed        : places for the others; by default all that no fixed thing has
    All assignments are tried where they are at most ``MOST_ENUMERATED``; else ``scipy.optimize.quadratic_assignment``
    from several starts (FAQ, then exchanges of two), with the neighbours of what that finds.
    Source: Koopmans & Beckmann 1957, Econometrica 25:53-76; FAQ: Vogelstein et al. 2015, PLOS ONE 10(4):e0121002.
    """
    n, m = _checked(flow, distance, now, fixed)
    moving = [thing for thing in range(n) if thing not in set(fixed)]
    taken = {now[thing] for thing in fixed}
    free = [place for place in (range(m) if allowed is None else sorted(set(allowed))) if place not in taken]
    if len(moving) > len(free):
        raise ValueError(f"{len(moving)} things do not fit on {len(free)} places")
    ways = perm(len(free), len(moving))
    exact = ways <= MOST_ENUMERATED
    found = _all(now, moving, free) if exact else _some(flow, distance, now, moving, free, seed, starts)
    cost = costs(flow, distance, found)
    return Assigned(tuple(_distinct(found, cost, distance, now, most)), exact, len(found))


def costs(flow: np.ndarray, distance: np.ndarray, place_of: np.ndarray) -> np.ndarray:
    """(C,) sum of flow times distance of each of some assignments (C, n)."""
    cost = np.zeros(len(place_of))
    for a, b in zip(*(ends.tolist() for ends in np.nonzero(flow))):
        cost += flow[a, b] * distance[place_of[:, a], place_of[:, b]]
    return cost


def changes_step_by_step(
    flow: np.ndarray,
    distance: np.ndarray,
    *,
    now: Sequence[int],
    fixed: Sequence[int] = (),
    allowed: Sequence[int] | None = None,
    steps: int,
) -> list[Assignment]:
    """What the best single change gives (two things exchanged, or one moved to a free place), then the best second
    one, and so on while it pays: for who can move little. None where something stands now where it may not.
    """
    moving = [thing for thing in range(len(now)) if thing not in set(fixed)]
    places = range(len(distance)) if allowed is None else sorted(set(allowed))
    if not {now[thing] for thing in moving} <= set(places):
        return []
    place_of = np.array(now)
    cost = float(costs(flow, distance, place_of[None])[0])
    path: list[Assignment] = []
    for _ in range(steps):
        near = _neighbours(place_of, moving, places)
        if not len(near):
            break
        of_near = costs(flow, distance, near)
        best = int(np.argmin(of_near))
        if of_near[best] >= cost * (1 - 1e-9):
            break
        place_of, cost = near[best], float(of_near[best])
        path.append(Assignment(tuple(place_of.tolist()), cost))
    return path


def _checked(flow: np.ndarray, distance: np.ndarray, now: Sequence[int], fixed: Sequence[int]) -> tuple[int, int]:
    n, m = len(flow), len(distance)
    if flow.shape != (n, n) or distance.shape != (m, m) or len(now) != n:
        raise ValueError(
            f"flow and distance are square, found {flow.shape} and {distance.shape}; {len(now)} are placed"
        )
    if n > m:
        raise ValueError(f"{n} things do not fit on {m} places")
    if not (np.isfinite(flow).all() and np.isfinite(distance).all()):
        raise ValueError("every flow and every distance must be a finite number")
    if len(set(now)) != n or any(not 0 <= thing < n for thing in fixed):
        raise ValueError("each thing has a place of its own, and only things can be fixed")
    return n, m


def _all(now: Sequence[int], moving: list[int], free: list[int]) -> np.ndarray:
    """(C, n) every assignment, in lexicographic order."""
    ways = np.array(list(permutations(free, len(moving))), dtype=np.int64).reshape(-1, len(moving))
    found = np.tile(np.array(now, dtype=np.int64), (len(ways), 1))
    found[:, moving] = ways
    return found


def _some(
    flow: np.ndarray,
    distance: np.ndarray,
    now: Sequence[int],
    moving: list[int],
    free: list[int],
    seed: int,
    starts: int,
) -> np.ndarray:
    """(C, n) where several starts end, with the neighbours of the best of these ends, each once."""
    ends = np.array([_from_start(flow, distance, now, moving, free, seed, k) for k in range(starts)])
    if {now[thing] for thing in moving} <= set(free):
        ends = np.vstack([ends, np.array(now)[None]])
    ends = np.unique(ends, axis=0)
    best = ends[np.argsort(costs(flow, distance, ends), kind="stable")[:5]]
    near = [_neighbours(one, moving, free) for one in best]
    return np.unique(np.vstack([ends, *near]), axis=0)


def _from_start(
    flow: np.ndarray,
    distance: np.ndarray,
    now: Sequence[int],
    moving: list[int],
    free: list[int],
    seed: int,
    start: int,
) -> list[int]:
    """One run of FAQ, from the flat start (number 0) or a random one, and exchanges of two until none pays."""
    from scipy.optimize import quadratic_assignment

    n, m = len(flow), len(distance)
    padded = np.zeros((m, m))
    padded[:n, :n] = flow
    stay = np.array([*((a, now[a]) for a in range(n) if a not in moving), *_nothing_on(now, moving, free, n, m)])
    stay = stay.reshape(-1, 2).astype(np.int64)
    rng = stream(seed, 0, "layout", "assignment", start)
    begin = "barycenter" if start == 0 else "randomized"
    first = quadratic_assignment(padded, distance, options={"partial_match": stay, "rng": rng, "P0": begin})
    guess = np.c_[np.arange(m), first.col_ind]
    then = quadratic_assignment(
        padded, distance, method="2opt", options={"partial_match": stay, "partial_guess": guess, "rng": rng}
    )
    return then.col_ind[:n].tolist()


def _nothing_on(now: Sequence[int], moving: list[int], free: list[int], n: int, m: int) -> Iterator[tuple[int, int]]:
    """(padding, place) of places that nothing may be put on: padding, which nobody goes to, stands there."""
    kept = {now[thing] for thing in range(n) if thing not in moving}
    shut = [place for place in range(m) if place not in kept and place not in free]
    yield from zip(range(n, m), shut)


def _neighbours(place_of: np.ndarray, moving: Sequence[int], places: Sequence[int] | range) -> np.ndarray:
    """(C, n) what one exchange of two things, or one thing moved to a free place, makes of an assignment."""
    empty = [place for place in places if place not in set(place_of.tolist())]
    found = []
    for a, b in combinations(moving, 2):
        other = place_of.copy()
        other[[a, b]] = place_of[[b, a]]
        found.append(other)
    for a in moving:
        for place in empty:
            other = place_of.copy()
            other[a] = place
            found.append(other)
    return np.array(found, dtype=np.int64).reshape(-1, len(place_of))


def _distinct(
    found: np.ndarray, cost: np.ndarray, distance: np.ndarray, now: Sequence[int], most: int
) -> Iterator[Assignment]:
    """The cheapest, each with other distances between its things than those before."""
    moved = (found != np.array(now)).sum(axis=1)
    scale = max(float(np.abs(cost).max(initial=0)), 1e-300)
    order = np.lexsort([*found.T[::-1], moved, np.rint(cost / scale * 1e12)])
    seen: set[bytes] = set()
    for rank in order:
        between = np.round(distance[np.ix_(found[rank], found[rank])], 9).tobytes()
        if between not in seen:
            seen.add(between)
            yield Assignment(tuple(found[rank].tolist()), float(cost[rank]))
        if len(seen) == most:
            return
