"""What a replication leaves in memory, and what many of them leave together: not much more, however many they are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.locked import Locked
from opsim.results import Key
from opsim.streams import stream

MOST_SAMPLES = 20_000
"""Values kept of each sample of a replication for histograms; more are thinned evenly."""
MOST_TOGETHER = 100_000
"""Values kept of each sample in all replications together."""

Sample = tuple[str, str]
"""(kpi, subject)"""
_known: dict[tuple[Key, ...], tuple[Key, ...]] = {}


@dataclass(frozen=True, slots=True)
class Replicated:
    """What one replication leaves in memory; its rows are in its events file."""

    replication: int
    figures: Sequence[Figure]
    samples: dict[Sample, np.ndarray]
    locked: Locked | None = None


class Figures(Sequence[Figure]):
    """Figures of one replication: 8 bytes each, as the names are there once for all replications that have the same."""

    __slots__ = ("_keys", "_values")

    def __init__(self, keys: Iterable[Key], values: Iterable[float]) -> None:
        named = tuple(keys)
        self._keys = _known.setdefault(named, named)
        self._values = np.array(tuple(values), dtype=float)

    @classmethod
    def of(cls, figures: Iterable[Figure]) -> Figures:
        """The same figures."""
        listed = list(figures)
        return cls((figure[:4] for figure in listed), (figure.value for figure in listed))

    def __len__(self) -> int:
        return len(self._keys)

    def __getitem__(self, at: Any) -> Any:
        if isinstance(at, slice):
            return [Figure(*key, value) for key, value in zip(self._keys[at], self._values[at].tolist())]
        key: Key = self._keys[at]
        return Figure(*key, float(self._values[at]))

    def __iter__(self) -> Iterator[Figure]:
        return iter(self[:])

    def __reduce__(self) -> Any:
        return Figures, (self._keys, self._values)


class Together:
    """Replications as they come, in any order; their samples are thinned so that all together stay within a bound.

    Of each sample all replications keep the same share of their values, drawn by lot: all, half, a quarter, ..., the
    first that keeps to the bound. The lot is that of the replication, so that the order they come in decides nothing.
    """

    def __init__(self, most: int = MOST_TOGETHER) -> None:
        self._most = most
        self._done: list[Replicated] = []
        self._sizes: dict[Sample, int] = {}
        self._halved: dict[Sample, int] = {}

    def __len__(self) -> int:
        return len(self._done)

    def add(self, one: Replicated) -> None:
        """One more; what was kept of the others may become less."""
        self._done.append(one := replace(one, samples=dict(one.samples)))
        for key in one.samples:
            if self._halved.get(key):
                _shuffle(one, key)
                for _ in range(self._halved[key]):
                    _halve(one, key)
            self._sizes[key] = self._sizes.get(key, 0) + one.samples[key].size
            while self._sizes[key] > max(self._most, len(self._done)):
                self._halve_all(key)

    def in_order(self) -> list[Replicated]:
        """All of them, by their number."""
        return sorted(self._done, key=lambda one: one.replication)

    def _halve_all(self, key: Sample) -> None:
        having = [one for one in self._done if key in one.samples]
        for one in having:
            if not self._halved.get(key):
                _shuffle(one, key)
            _halve(one, key)
        self._halved[key] = self._halved.get(key, 0) + 1
        self._sizes[key] = sum(one.samples[key].size for one in having)


def _shuffle(one: Replicated, key: Sample) -> None:
    one.samples[key] = stream(0, one.replication, "kept", *key).permutation(one.samples[key])


def _halve(one: Replicated, key: Sample) -> None:
    """Values that were shuffled become half as many; a single one stays."""
    one.samples[key] = one.samples[key][: (one.samples[key].size + 1) // 2].copy()


def together(done: Iterable[Replicated]) -> list[Replicated]:
    """Replications by their number, their samples within the bound for all."""
    kept = Together()
    for one in done:
        kept.add(one)
    return kept.in_order()


def thinned(values: np.ndarray, most: int) -> np.ndarray:
    """At most so many of the values, evenly among them by size; as they are, where they are not more."""
    if values.size <= most:
        return values
    middle = (np.arange(most) + 0.5) * values.size / most - 0.5  # of as many equal parts
    down = np.arange(most) % 2 == 0  # by turns, as parts of two values have no middle one
    return np.sort(values)[np.where(down, np.floor(middle), np.ceil(middle)).astype(int)]
