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
    """Puts the held frames of one region together, over the edges of stretches too."""

    def __init__(self, gap_s: float):
        self._gap_s = gap_s
        self._parts: list[np.ndarray] = []

    def add(
        self, worker: int, start_s: np.ndarray, seconds: np.ndarray, angle_deg: np.ndarray, held: np.ndarray
    ) -> None:
        """The next stretch, each (N,), in the order of time."""
        at = np.flatnonzero(held)
        if not at.size:
            return
        end_s = start_s + seconds
        begins = np.flatnonzero(np.r_[True, (np.diff(at) > 1) | (start_s[at[1:]] - end_s[at[:-1]] > self._gap_s)])
        last = np.r_[begins[1:], at.size] - 1
        lasting = np.add.reduceat(seconds[at], begins)
        lean = np.add.reduceat(seconds[at] * angle_deg[at], begins)
        who = np.full(begins.size, worker)
        self._parts.append(np.stack([who, start_s[at[begins]], end_s[at[last]], lasting, lean], axis=1))

    def runs(self) -> Runs:
        """All of them; what goes on from one stretch to the next is one."""
        found = np.concatenate([np.empty((0, 5)), *self._parts])
        worker, start_s, end_s, lasting, lean = found.T
        goes_on = (worker[1:] == worker[:-1]) & (np.abs(start_s[1:] - end_s[:-1]) <= self._gap_s)
        begins = np.flatnonzero(np.r_[True, ~goes_on][: len(found)])
        if not begins.size:
            return Runs(worker.astype(int), start_s, lasting, lean)
        seconds = np.add.reduceat(lasting, begins)
        angle_deg = np.add.reduceat(lean, begins) / seconds
        return Runs(worker[begins].astype(int), start_s[begins], seconds, angle_deg)
