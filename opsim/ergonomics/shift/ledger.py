"""How long workers were at which score and in which angle: seconds by worker, station, task, product and hour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np


class Bins(NamedTuple):
    """n of them, each 1 wide: the first begins at ``first``. Scores have a bin each, angles one a degree."""

    first: int
    n: int


_SCORES = {"rula": Bins(1, 7), "reba": Bins(1, 15), "owas": Bins(1, 4)}
AT_MOST = "_at_most"
BINS = {
    **_SCORES,
    **{name + AT_MOST: bins for name, bins in _SCORES.items()},
    "trunk": Bins(-180, 360),
    "arm": Bins(0, 180),
}
"""What is counted: RULA's grand score, REBA's score and OWAS's action category, each as low and as high (``_at_most``)
as it may be; flexion of the trunk and elevation of the arm that is higher, in degrees."""
KEY = ("worker", "station", "task", "product", "hour")
"""``hour`` is that of the day, 0 to 23."""


@dataclass(frozen=True, eq=False)
class Ledger:
    """Seconds of M cells; together they are all the time of the frames.

    key  : (M, 5) by ``KEY``; ranks, -1 for none, and WALKING or WAITING in place of a task
    bins : by the names of ``BINS``: (M, 1 + n) seconds; column 0 is time for which it is not known
    """

    key: np.ndarray
    bins: dict[str, np.ndarray]

    @property
    def seconds(self) -> np.ndarray:
        """(M,) of all time."""
        return self.bins["rula"].sum(axis=1)

    @property
    def unmeasured_s(self) -> np.ndarray:
        """(M,) of time whose posture nobody knows."""
        return self.bins["rula"][:, 0]

    def known_s(self, name: str) -> np.ndarray:
        """(M,) seconds for which a score or an angle is known."""
        return self.bins[name][:, 1:].sum(axis=1)

    def from_s(self, name: str, value: int) -> np.ndarray:
        """(M,) seconds at a score of ``value`` or more; with an angle of so many whole degrees or more."""
        return self.bins[name][:, 1 + value - BINS[name].first :].sum(axis=1)

    def score_seconds(self, name: str) -> np.ndarray:
        """(M,) a score, integrated over the seconds for which it is known."""
        first, n = BINS[name]
        return self.bins[name][:, 1:] @ np.arange(first, first + n, dtype=float)

    def where(self, rows: np.ndarray | list[int]) -> Ledger:
        """Some cells, by mask or number."""
        return Ledger(self.key[rows], {name: seconds[rows] for name, seconds in self.bins.items()})

    def by(self, column: str, values: np.ndarray) -> Ledger:
        """All cells put together by one column of the key: a cell for each of some values, in their order."""
        where = {int(value): place for place, value in enumerate(values)}
        own = self.key[:, KEY.index(column)]
        place = np.array([where.get(int(value), -1) for value in own], dtype=int)
        key = np.full((len(values), len(KEY)), -1)
        key[:, KEY.index(column)] = values
        bins = {name: np.zeros((len(values), seconds.shape[1])) for name, seconds in self.bins.items()}
        for name, seconds in self.bins.items():
            np.add.at(bins[name], place[place >= 0], seconds[place >= 0])
        return Ledger(key, bins)

    def together(self) -> Ledger:
        """All cells as one."""
        bins = {name: seconds.sum(axis=0, keepdims=True) for name, seconds in self.bins.items()}
        return Ledger(np.full((1, len(KEY)), -1), bins)
