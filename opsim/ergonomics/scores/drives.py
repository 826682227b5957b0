"""How many points of a score each part of the body brings in."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import factorial
from typing import Any

import numpy as np

SAID_LEAST = {"FOREARM": 1, "OWAS_LOAD": 1}
"""Least of what the scenario says, where it is not 0."""


@dataclass(frozen=True)
class State:
    """Sub-scores (22, 2), what is said (10, 2), and how much time adds: muscle use, activity."""

    codes: np.ndarray
    said: np.ndarray
    time: int

    def less(self, codes: dict[int, int], said: dict[int, int], *, time: bool) -> State:
        """With some of them at their least."""
        less = replace(self, codes=self.codes.copy(), said=self.said.copy(), time=0 if time else self.time)
        for array, rows in ((less.codes, codes), (less.said, said)):
            for row, least in rows.items():
                array[row] = least
        return less


def drives_of(
    kernel: Any, state: State, arms: Callable, rows: dict[str, dict[int, int]], said: Mapping[str, tuple[str, ...]]
) -> dict[str, float]:
    """How many points of the score (the middle of low and high) each part brings in, the most first.

    Source: Shapley 1953, A value for n-person games: what a part adds, on average over all orders in which the parts
    can go from their least to what they are. One part alone often changes nothing, as the tables saturate.
    """
    parts = tuple(dict.fromkeys((*rows, *said, *(("time",) if state.time else ()))))
    states = {part: ({getattr(kernel, name): SAID_LEAST.get(name, 0) for name in said.get(part, ())}) for part in parts}
    worth = np.empty(2 ** len(parts))
    for there in range(worth.size):
        away = [part for bit, part in enumerate(parts) if not there >> bit & 1]
        least = {row: code for part in away for row, code in rows.get(part, {}).items()}
        unsaid = {row: code for part in away for row, code in states[part].items()}
        worth[there] = arms(state.less(least, unsaid, time="time" in away)).max(axis=1).mean()
    found = {part: _share(worth, bit, len(parts)) for bit, part in enumerate(parts)}
    return dict(sorted(((part, more) for part, more in found.items() if abs(more) > 1e-9), key=lambda one: -one[1]))


def _share(worth: np.ndarray, bit: int, n: int) -> float:
    """The Shapley value of a part out of n, from what each set of them (a bit each) is worth."""
    sets = np.arange(worth.size)
    without = sets[sets >> bit & 1 == 0]
    sizes = [int(one).bit_count() for one in without.tolist()]
    weights = np.array([factorial(size) * factorial(n - 1 - size) for size in sizes]) / factorial(n)
    return float(weights @ (worth[without | 1 << bit] - worth[without]))
