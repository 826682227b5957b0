"""The terms of a response: what a factor, its square, and two factors together add to a figure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

Part = tuple[int, int]
"""(factor, what of it): 1 and 2 are its first and second power; -k is its k-th category against the mean of all."""


@dataclass(frozen=True, slots=True)
class Room:
    """What the points are spread over.

    low, high  : (F,) ends of each factor; they are -1 and 1 for the fit
    categories : (F,) number of categories of a factor whose values are 0, 1, 2, ... without order; 0 for numbers
    """

    low: np.ndarray
    high: np.ndarray
    categories: tuple[int, ...]

    @property
    def centre(self) -> np.ndarray:
        """(F,) the middle of each factor."""
        return (self.low + self.high) / 2

    @property
    def half(self) -> np.ndarray:
        """(F,) half the range of each factor; 1 where it has none."""
        return np.where(self.high > self.low, (self.high - self.low) / 2, 1.0)

    def scaled(self, points: np.ndarray) -> np.ndarray:
        """(P, F) numbers from -1 to 1; categories stay as they are."""
        plain = np.array(self.categories) > 0
        return np.where(plain, points, (points - self.centre) / self.half)


def first_parts(room: Room, points: np.ndarray) -> list[list[Part]]:
    """For each factor the parts of a response that is linear in it; none where it has one value only."""
    found = []
    for factor, n in enumerate(room.categories):
        seen = np.unique(points[:, factor]).size
        found.append([] if seen < 2 else [(factor, -k) for k in range(1, n)] if n else [(factor, 1)])
    return found


def offers(room: Room, points: np.ndarray) -> list[tuple[str, list[tuple[Part, ...]]]]:
    """Responses that may be fitted, by name, from the least: linear, with squares, with interactions, with both."""
    first = first_parts(room, points)
    linear: list[tuple[Part, ...]] = [(), *((part,) for parts in first for part in parts)]
    numbers = [f for f, n in enumerate(room.categories) if not n and np.unique(points[:, f]).size > 2]
    squares: list[tuple[Part, ...]] = [((factor, 2),) for factor in numbers]
    pairs: list[tuple[Part, ...]] = [(a, b) for one, other in combinations(first, 2) for a in one for b in other]
    found = [("linear", linear)]
    if squares:
        found.append(("linear with squares", linear + squares))
    if pairs:
        found.append(("linear with interactions", linear + pairs))
    if squares and pairs:
        found.append(("quadratic", linear + squares + pairs))
    return found


def columns(terms: Sequence[tuple[Part, ...]], scaled: np.ndarray, room: Room) -> np.ndarray:
    """(P, C) what each term multiplies. scaled : (P, F) as ``Room.scaled`` gives them"""
    found = np.ones((len(scaled), len(terms)))
    for place, term in enumerate(terms):
        for factor, what in term:
            x = scaled[:, factor]
            found[:, place] *= x**what if what > 0 else (x == -what) * 1.0 - (x == 0)
    return found
