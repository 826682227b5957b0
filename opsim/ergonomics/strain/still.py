"""A fold over workers' days: static postures by ISO 11226, zones of EN 1005-4, movements a minute."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from opsim.ergonomics.shift.stretch import Frames
from opsim.ergonomics.strain.held_runs import Runs, RunsOf
from opsim.ergonomics.strain.holds import REGIONS, STATIC_WORK, StaticMarker, region_angles_deg
from opsim.ergonomics.strain.limits import NOT_RECOMMENDED
from opsim.ergonomics.strain.movements import Movements
from opsim.ergonomics.strain.zones import ZONED, Zoned, zoned_angles_deg

_HELD = {"trunk": "trunk", "left_arm": "left_arm", "right_arm": "right_arm", "neck": "head"}
"""The region whose holding makes a zone static; nobody looks at how long one is twisted."""
MOVED_DEG = 20.0
"""Trunk, and arms whichever way, have moved when they went beyond this, where EN 1005-4's and ISO 11226's zones of rest
end."""


class Still:
    """Counts for n workers, whose frames come one after the other, in stretches of one worker that do not share a
    minute of the clock; what he holds and how he moves goes on from one to the next.

    not_acceptable_s : (n, ZONED) seconds that EN 1005-4 does not accept; known_s : (n, ZONED) seconds with an angle
    moves            : (n, ZONED) movements beyond ``MOVED_DEG``
    held_s           : (n, REGIONS) seconds in static postures out of neutral
    """

    def __init__(self, n_workers: int, start_s: float = 0.0):
        self._start_s = start_s
        self._marker, self._late = StaticMarker(STATIC_WORK, REGIONS), deque[Frames]()
        self._runs = {region: RunsOf(STATIC_WORK.band_deg, STATIC_WORK.gap_s) for region in REGIONS}
        self._worker: int | None = None
        self.not_acceptable_s, self.known_s, self.moves = (np.zeros((n_workers, len(ZONED))) for _ in range(3))
        self.held_s = np.zeros((n_workers, len(REGIONS)))

    def add(self, frames: Frames, scores: Any = None) -> None:
        """The next stretch."""
        self._late.append(frames)
        for marks in self._marker.push(frames.worker, frames.start_s, frames.seconds, frames.measures):
            self._count(self._late.popleft(), marks)

    def close(self) -> dict[str, Runs]:
        """No more frames come: all holds, by region."""
        for marks in self._marker.close():
            self._count(self._late.popleft(), marks)
        return {region: runs.runs() for region, runs in self._runs.items()}

    def _count(self, frames: Frames, marks: np.ndarray) -> None:
        rank, seconds = frames.worker, frames.seconds
        if rank != self._worker:
            self._worker = rank
            self._zoned = {region: Zoned(region) for region in ZONED}
            self._moves = {region: Movements(MOVED_DEG) for region in ZONED}
        angles_deg = region_angles_deg(frames.measures, REGIONS, behind=True)
        held = dict(zip(REGIONS, marks.T))
        self.held_s[rank] += seconds @ marks
        for place, (region, runs) in enumerate(self._runs.items()):
            runs.add(rank, frames.start_s, seconds, angles_deg[:, place], held[region])
        never = np.zeros(len(frames), bool)
        clock_s = frames.start_s + self._start_s
        for place, (region, angle_deg) in enumerate(zoned_angles_deg(frames.measures).items()):
            found = self._zoned[region].verdicts(angle_deg, held.get(_HELD.get(region, ""), never), clock_s)
            self.not_acceptable_s[rank, place] += seconds[found == NOT_RECOMMENDED].sum()
            self.known_s[rank, place] += seconds[found >= 0].sum()
            raised_deg = np.abs(angle_deg) if region.endswith("_arm") else angle_deg
            self.moves[rank, place] += self._moves[region].next(raised_deg).sum()
