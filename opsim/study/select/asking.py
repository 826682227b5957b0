"""How procedures ask for replications: of any model that answers, ours, SimPy's or another's."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from opsim.kpi.better import LESS, MORE

AT_MOST, AT_LEAST = "<=", ">="


class Ask(NamedTuple):
    """Replications first, ..., upto - 1 of one system (numbered from 0)."""

    system: int
    first: int
    upto: int


Observe = Callable[[Sequence[Ask]], Sequence[np.ndarray]]
"""For each ask an array (upto - first, 1 + limits): the figure, then the figure of each limit; (n,) without limits.

Procedures ask for all that they need next at once, so that many processes can answer. The same replication of the same
system must always have the same values.
"""


def each(function: Callable[[int, int, int], np.ndarray]) -> Observe:
    """An Observe from ``function(system, first, upto)``, which answers one ask after the other."""
    return lambda asks: [function(*ask) for ask in asks]


@dataclass(frozen=True, slots=True)
class Limit:
    """The mean of a figure is to be at most (``<=``) or at least (``>=``) ``bound``.

    tolerance : a system whose mean is nearer to the bound than this may be called either, above 0
    """

    name: str
    bound: float
    tolerance: float
    sense: str = AT_MOST

    def __post_init__(self) -> None:
        if self.sense not in (AT_MOST, AT_LEAST):
            raise ValueError(f"limit on {self.name}: expected {AT_MOST} or {AT_LEAST}, found {self.sense!r}")
        if not (np.isfinite(self.bound) and self.tolerance > 0):
            raise ValueError(f"limit on {self.name}: expected a number and a tolerance above 0")

    def over(self, values: np.ndarray) -> np.ndarray:
        """By how much values are beyond the limit; below 0 where they are within it."""
        return values - self.bound if self.sense == AT_MOST else self.bound - values


class Answered:
    """What was asked so far of each system, as it came: ``values[i]`` is (n_i, 1 + limits)."""

    def __init__(self, observe: Observe, systems: Sequence[str], figures: Sequence[str]):
        self._observe, self._systems, self._figures = observe, tuple(systems), tuple(figures)
        self.values = [np.empty((0, len(figures))) for _ in systems]

    @property
    def n(self) -> tuple[int, ...]:
        return tuple(len(of) for of in self.values)

    def upto(self, wanted: Mapping[int, int]) -> None:
        """Ask, in one go, for what is missing of systems: number -> replications in all.

        Raises ValueError where an answer has another shape, or holds no number.
        """
        asks = [Ask(i, len(self.values[i]), upto) for i, upto in wanted.items() if upto > len(self.values[i])]
        if not asks:
            return
        for ask, found in zip(asks, self._observe(asks), strict=True):
            self.values[ask.system] = np.concatenate([self.values[ask.system], self._checked(ask, found)])

    def _checked(self, ask: Ask, found: np.ndarray) -> np.ndarray:
        wanted = (ask.upto - ask.first, len(self._figures))
        values = np.asarray(found, dtype=float)
        if values.ndim == 1 and wanted[1] == 1:
            values = values[:, None]
        if values.shape != wanted:
            raise ValueError(f"{self._systems[ask.system]}: expected values of shape {wanted}, found {values.shape}")
        if not np.isfinite(values).all():
            row, column = (int(place[0]) for place in np.nonzero(~np.isfinite(values)))
            named = f"{self._systems[ask.system]}: replication {ask.first + row}"
            raise ValueError(
                f"{named}: nothing was observed of {self._figures[column]}; a choice needs a number of each"
            )
        return values


def sign_of(better: str) -> float:
    """1 where more is better, -1 where less is."""
    if better not in (MORE, LESS):
        raise ValueError(f"better: expected {MORE!r} or {LESS!r}, found {better!r}")
    return 1.0 if better == MORE else -1.0
