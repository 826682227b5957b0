"""Which region of the body a high RULA score comes from, over a whole shift."""

from __future__ import annotations

from math import factorial

import numpy as np

from opsim.ergonomics.options import Options
from opsim.ergonomics.scores.bounds import Bounds
from opsim.ergonomics.scores.scoring import Scores, edges_of, phases_of, places, tables_of
from opsim.ergonomics.shift.scored import said_of
from opsim.ergonomics.shift.stretch import Frames
from opsim.plan import Plan

REGIONS = ("trunk", "neck", "arms", "wrists", "legs", "load", "time")
"""``arms`` are the upper arms and forearms; ``time`` is what repeating or holding adds."""
LEVELS = (5, 7)
EVERY = 8
"""Of frames at a high score each so-manieth is looked at, and stands for those about it."""
_WEIGHTS = np.array([factorial(n) * factorial(6 - n) / factorial(7) for n in range(7)])


class Regions:
    """A fold over the frames of a day. ``seconds``: (workers, regions, levels) of time at RULA 5 (7) or more, by the
    least that it may be, dealt out to the regions by how many points of the score each brings in.

    So those of all regions sum to the time at that score. Source of the shares: Shapley 1953, as ``explained.explain``.
    """

    def __init__(self, plan: Plan):
        self._plan = plan
        self.seconds = np.zeros((len(plan.workers), len(REGIONS), len(LEVELS)))

    def add(self, frames: Frames, scores: Scores) -> None:
        """Count a stretch."""
        for task in np.unique(frames.task[scores.rula[:, 0] >= LEVELS[0]]).tolist():
            rows = np.flatnonzero((frames.task == task) & (scores.rula[:, 0] >= LEVELS[0]))
            sample = rows[(EVERY - 1) // 2 :: EVERY] if rows.size > EVERY else rows
            share = shares(points(frames.some(sample), said_of(task, self._plan), self._plan.ergonomics))
            for column, level in enumerate(LEVELS):
                self.seconds[frames.worker, :, column] += _dealt(frames, scores, rows, sample, share, level)


def _dealt(frames: Frames, scores: Scores, rows: np.ndarray, sample: np.ndarray, share: np.ndarray, level: int):
    """(regions,) seconds of ``rows`` at a level or more, dealt out as their sample is; as all of it where none is."""
    whole_s = frames.seconds[rows[scores.rula[rows, 0] >= level]].sum()
    weight = frames.seconds[sample] * (scores.rula[sample, 0] >= level)
    weight = weight if weight.sum() > 0 else frames.seconds[sample]
    return whole_s * (weight @ share) / weight.sum()


def points(frames: Frames, bounds: Bounds, options: Options) -> np.ndarray:
    """(N, regions) points of RULA that each brings in, of frames of one task: together the middle of the least and the
    most that it may be, less 1."""
    from opsim.ergonomics.kernels import scores as kernel
    from opsim.ergonomics.kernels.driving import drive

    rows = [kernel.NECK, kernel.TRUNK, kernel.LEGS]
    rows += [kernel.ARM + side * kernel.ARM_CODES + part for side in range(2) for part in range(3)]
    phases = phases_of(bounds)
    force = kernel.FORCE if options.rula_force == "paper" else kernel.FORCE_WORKSHEET
    codes, found = np.empty((len(frames), 9, 2), np.int64), np.empty((len(frames), len(REGIONS)))
    edges, at, own = edges_of(options.thresholds), places(), np.empty((kernel.ARM + 2 * kernel.ARM_CODES, 2), np.int64)
    for n, (row, carrying) in enumerate(zip(np.asarray(frames.measures, float), frames.carrying)):
        kernel.find_codes(row, at, edges, phases[int(carrying)], bounds.walking, own)
        codes[n] = own[rows]
    time = np.stack([frames.repeated | frames.static, frames.carrying], axis=1).astype(np.int64)
    tables = tables_of(options.rula_table_a, options.owas_disputed)[:3]
    drive(codes, np.ascontiguousarray(phases[:, [kernel.FOREARM, force]]), time, _WEIGHTS, *tables, found)
    return found


def shares(found: np.ndarray) -> np.ndarray:
    """(N, regions) of points, each row made to sum to 1."""
    return found / found.sum(axis=1, keepdims=True)
