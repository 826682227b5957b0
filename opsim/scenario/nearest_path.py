"""The path of a scenario that is most like one that leads nowhere: parts mistyped, left out, or too many."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import SequenceMatcher
from functools import lru_cache
from heapq import heappop, heappush
from itertools import count

from opsim.scenario.known_paths import Spot, step, top, words
from opsim.scenario.positions import Node

LEAST_LIKE = 0.6
"""Of two words, as in difflib: less is another word."""
LEFT_OUT, TOO_MANY = 0.3, 0.7
MOST_STEPS = 5000
"""That are looked at: a hint must be quick."""


def nearest_path(root: Node, parts: Sequence[str]) -> str | None:
    """The dotted path that stands in the tree, or may, with the fewest changes of parts; None where none is near.

    The cheapest way through the tree (Dijkstra): a mistyped part costs what it lacks in likeness, one left out 0.3, one
    too many 0.7; the last part is always one that was meant.
    """
    most = 0.25 + 0.35 * len(parts)
    order = count()
    waiting: list[tuple[float, int, int, Spot]] = [(0.0, next(order), 0, top(root))]
    done: set[tuple[tuple[str, ...], int]] = set()
    while waiting:
        cost, _, n_used, spot = heappop(waiting)
        if n_used == len(parts) and spot.path:
            return ".".join(spot.path)
        if (spot.path, n_used) in done:
            continue
        done.add((spot.path, n_used))
        for more, used, part in _next(root, spot, parts[n_used:]):
            below = spot if part is None else step(root, spot, part)
            if cost + more <= most and below is not None and len(waiting) < MOST_STEPS:
                heappush(waiting, (cost + more, next(order), n_used + used, below))
    return None


def _next(root: Node, spot: Spot, left: Sequence[str]) -> list[tuple[float, int, str | None]]:
    """(cost, parts used, word or None) of each way to go on."""
    if not left:
        return []
    ways: list[tuple[float, int, str | None]] = [(TOO_MANY, 1, None)] if len(left) > 1 else []
    for word in words(root, spot):
        alike = _likeness(left[0].casefold()[:60], word.casefold()[:60])
        if alike >= LEAST_LIKE:
            ways.append((1 - alike, 1, word))
        ways.append((LEFT_OUT, 0, word))
    return ways


@lru_cache(50_000)
def _likeness(one: str, other: str) -> float:
    if one == other:
        return 1.0
    matcher = SequenceMatcher(None, one, other)
    if matcher.real_quick_ratio() < LEAST_LIKE or matcher.quick_ratio() < LEAST_LIKE:
        return 0.0
    return matcher.ratio()
