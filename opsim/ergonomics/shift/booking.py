"""Frames and their scores are booked, stretch by stretch, into a ledger."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.ergonomics.columns import AT
from opsim.ergonomics.shift.ledger import AT_MOST, BINS, KEY, Ledger
from opsim.ergonomics.shift.stretch import Frames

HOUR_S, HOURS = 3600.0, 24
ARMS = [AT["left_arm_elevation"], AT["right_arm_elevation"]]


class Booking:
    """A fold over the frames of a day; ``close`` gives the ledger. A cell takes 5 kB, and there are few."""

    def __init__(self, start_s: float = 0.0):
        """start_s : when on the clock the run begins."""
        self._start_s = start_s
        self._cells: dict[tuple[int, ...], int] = {}
        self._bins = {name: np.zeros((0, 1 + bins.n)) for name, bins in BINS.items()}

    def add(self, frames: Frames, scores: Any) -> None:
        """Book a stretch, which lies within an hour of the clock; scores : as ``shift.scored`` gives them."""
        hour = int((self._start_s + frames.start_s[0]) // HOUR_S) % HOURS
        keys, cell = _cells(frames)
        rows = [self._cell((frames.worker, *key, hour)) for key in keys]
        for name, place in _places(frames, scores).items():
            width = 1 + BINS[name].n
            found = np.bincount(cell * width + place, frames.seconds, len(rows) * width)
            self._bins[name][rows] += found.reshape(-1, width)

    def close(self) -> Ledger:
        """All that was booked, by key."""
        keys = np.array(list(self._cells), dtype=int).reshape(-1, len(KEY))
        order = np.lexsort(keys.T[::-1])
        return Ledger(keys[order], {name: bins[: len(keys)][order] for name, bins in self._bins.items()})

    def _cell(self, key: tuple[int, ...]) -> int:
        """The row of a cell; there is room for more rows than are taken."""
        row = self._cells.setdefault(key, len(self._cells))
        if row >= len(self._bins["rula"]):
            more = max(16, row)
            self._bins = {name: np.r_[bins, np.zeros((more, bins.shape[1]))] for name, bins in self._bins.items()}
        return row


def _cells(frames: Frames) -> tuple[list[tuple[int, ...]], np.ndarray]:
    """Station, task and product of each cell of a stretch, and (N,) in which of them each frame is.

    NOTE: looked for among runs of frames of one row of the log, of which there are a hundred times fewer.
    """
    first = np.flatnonzero(np.r_[True, frames.row[1:] != frames.row[:-1]])
    named = np.stack([frames.station[first], frames.task[first], frames.product[first]], axis=1)
    keys, cell = np.unique(named, axis=0, return_inverse=True)
    return [tuple(key) for key in keys.tolist()], np.repeat(cell.ravel(), np.diff(np.r_[first, len(frames)]))


def _places(frames: Frames, scores: Any) -> dict[str, np.ndarray]:
    """By the names of ``BINS``: (N,) the column of each frame, 0 where it is not known."""
    found: dict[str, np.ndarray] = {}
    for name in ("rula", "reba", "owas"):
        both = getattr(scores, name)
        found |= {name: both[:, 0].astype(int), name + AT_MOST: both[:, 1].astype(int)}
    angles = {"trunk": frames.measures[:, AT["trunk_flexion"]], "arm": np.fmax(*frames.measures[:, ARMS].T)}
    return found | {name: _degree(name, angle) for name, angle in angles.items()}


def _degree(name: str, angle: np.ndarray) -> np.ndarray:
    first, n = BINS[name]
    place = np.clip(np.floor(np.nan_to_num(angle)).astype(int) - first, 0, n - 1)
    return np.where(np.isnan(angle), 0, 1 + place)
