"""Streams of one replication that give many blocks at once: what ``Items.block`` of ``draws.py`` gives, as arrays."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from opsim.engine.fast_engine.luck.kinds import Drawn, NoLuck, OfAKind
from opsim.engine.fast_engine.luck.sampled import DrawnHeld, Held
from opsim.streams import BLOCK


class Stream:
    """Numbers of one name: items ``first * 64`` to ``(first + n) * 64 - 1`` are its blocks ``first`` and after."""

    __slots__ = ("drawn", "words")

    def __init__(self, key: bytes, drawn: Drawn):
        self.words, self.drawn = np.frombuffer(key, np.uint32), drawn

    def fill(self, first: int, n: int) -> np.ndarray:
        """(n * 64,) the numbers of n blocks: seconds or shares in float64, ranks in int64. Any order, any thread."""
        return self.drawn(self.words, first, n)


class HeldStream:
    """As ``Stream``, of performances in which a tool is held."""

    __slots__ = ("drawn", "words")

    def __init__(self, key: bytes, drawn: DrawnHeld):
        self.words, self.drawn = np.frombuffer(key, np.uint32), drawn

    def fill(self, first: int, n: int) -> Held:
        """Three of (n * 64,) float64: seconds, and the shares of them from which to which the tool is held."""
        return self.drawn(self.words, first, n)


uniforms = OfAKind("uniform", lambda n, rng: rng.random(n))
"""In [0, 1)."""


def exponentials(mean_s: float) -> Drawn:
    """The gaps of a Poisson process."""
    return OfAKind("exponential", lambda n, rng, mean_s: rng.exponential(mean_s, n), (mean_s,))


def drawn_ranks(ranks: Sequence[int], cumulative: Sequence[float]) -> Drawn:
    """Rank i of ``ranks`` with probability cumulative[i] - cumulative[i - 1]."""
    found, bounds = np.array(ranks, np.int64), np.array(cumulative)
    kind = "rank", *ranks, *cumulative
    return OfAKind(kind, lambda n, rng: found[np.searchsorted(bounds, rng.random(n), side="right")])


def ranks_by_number(rank_of: Callable[[np.ndarray], np.ndarray]) -> Drawn:
    """Ranks that no luck decides: ``rank_of`` (k,) job numbers -> (k,) int64."""
    return NoLuck(lambda _words, first, n: rank_of(np.arange(first * BLOCK, (first + n) * BLOCK)))
