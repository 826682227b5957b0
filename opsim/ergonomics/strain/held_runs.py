"""Each posture that is held, from when on, how long and at which angle: marks of frames made into runs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Runs:
    """H holds of one region, each (H,): whose, from when on, how long, and the mean angle in degrees."""

    worker: np.ndarray
    start_s: np.ndarray
    seconds: np.ndarray
    angle_deg: np.ndarray


class RunsOf:
    """Puts the held frames of one region together, over the edges of stretches too.

    Held frames one after the other may be several holds: a stoop of 25 degrees, one of 70, and one of 25 again. A hold
    stays within ``band_deg``; where frames do not, the longest part that does is one, then the longest of what is left
    before and after it, and so on. So the longest hold is the longest there is, and no second belongs to two.

    gap_s : longer than this without a frame, and a hold is over
    """

    def __init__(self, band_deg: float, gap_s: float):
        self._band_deg, self._gap_s = band_deg, gap_s
        self._open: list[np.ndarray] = []
        self._parts: list[np.ndarray] = [np.empty((0, 4))]
        self._n_frames = 0

    def add(
        self, worker: int, start_s: np.ndarray, seconds: np.ndarray, angle_deg: np.ndarray, held: np.ndarray
    ) -> None:
        """The next stretch, each (N,), in the order of time. What is held at its end is kept until it is over."""
        at = np.flatnonzero(held)
        if at.size:
            who, number = np.full(at.size, worker, float), self._n_frames + at
            self._open.append(np.stack([who, number, start_s[at], seconds[at], angle_deg[at]], axis=1))
        self._n_frames += held.size
        if self._open and held.size and not held[-1]:
            self._cut()

    def runs(self) -> Runs:
        """All of them, in the order in which they came."""
        if self._open:
            self._cut()
        worker, start_s, seconds, angle_deg = np.concatenate(self._parts).T
        return Runs(worker.astype(int), start_s, seconds, angle_deg)

    def _cut(self) -> None:
        """The held frames that are kept become holds."""
        from opsim.ergonomics.kernels.hold_parts import hold_parts

        frames, self._open = np.concatenate(self._open), []
        worker, number, start_s, seconds, angle_deg = np.ascontiguousarray(frames.T)
        late = start_s[1:] - (start_s + seconds)[:-1] > self._gap_s
        apart = late | (np.diff(worker) != 0) | (np.diff(number) > 1)
        edges, begins = np.r_[0, np.flatnonzero(apart) + 1, worker.size], np.zeros(worker.size, bool)
        hold_parts(angle_deg, seconds, edges, self._band_deg, begins)
        first = np.flatnonzero(begins)
        lasting = np.add.reduceat(seconds, first)
        mean_deg = np.add.reduceat(seconds * angle_deg, first) / lasting
        self._parts.append(np.stack([worker[first], start_s[first], lasting, mean_deg], axis=1))
