"""Which streams can be drawn together: those of a kind, whose numbers are each made of luck and a few numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.engine.fast_engine.luck.trust import blocks_of
from opsim.streams import BLOCK

Drawn = Callable[[np.ndarray, int, int], np.ndarray]
"""(key words, first block, number of blocks) -> (n_blocks * 64,) seconds, shares or ranks."""


@dataclass(frozen=True, eq=False, slots=True)
class OfAKind:
    """A ``Drawn`` whose streams can be drawn together with others of the same kind.

    kind    : equal for streams that one ``draw`` can give, hashable
    draw    : (n, generator, *numbers) -> (n,); numbers, or arrays of (n,) where streams differ
    numbers : by which a stream differs from others of its kind
    """

    kind: Any
    draw: Callable[..., np.ndarray]
    numbers: tuple[float, ...] = ()

    def __call__(self, words: np.ndarray, first: int, n: int) -> np.ndarray:
        return self.draw(n * BLOCK, blocks_of(words, first, n), *self.numbers)


@dataclass(frozen=True, eq=False, slots=True)
class NoLuck:
    """A ``Drawn`` that asks no luck: the same in every replication."""

    drawn: Drawn

    def __call__(self, words: np.ndarray, first: int, n: int) -> np.ndarray:
        return self.drawn(words, first, n)


@dataclass(frozen=True, eq=False, slots=True)
class HeldAtShares:
    """How performances are drawn in which a tool is held from one share of each to another."""

    drawn: Drawn
    start: float
    end: float

    def __call__(self, words: np.ndarray, first: int, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.drawn(words, first, n), np.full(n * BLOCK, self.start), np.full(n * BLOCK, self.end)


def of_model(model: Any, effect: Any) -> Drawn:
    """Times of a model of this package that makes each of the luck of its own place, for a worker of this effect."""
    from opsim.tasks.model import ByNumbers, SharedTime
    from opsim.tasks.simple import Fixed

    if isinstance(model, Fixed):
        return NoLuck(OfAKind(id(model), lambda n, rng: model.sample(n, rng).duration_s))
    if isinstance(model, ByNumbers):
        return OfAKind(type(model), type(model).sample_side_by_side_s, model.numbers(effect))
    if isinstance(model, SharedTime) and isinstance(effect, float):
        return OfAKind(id(model), lambda n, rng, own: model.sample(n, rng, worker=own).duration_s, (effect,))
    return OfAKind((id(model), id(effect)), lambda n, rng: model.sample(n, rng, worker=effect).duration_s)
