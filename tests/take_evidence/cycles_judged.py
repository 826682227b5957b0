"""Cycle boundaries against recorded foot contact."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

TOLERANCE_FRAMES = 3
SHORTEST_FRAMES = 3
"""A contact, or a lift, of fewer frames is a flicker of the derived label."""


@dataclass(frozen=True)
class Judged:
    """Of one take: cycles found that could be judged and those right; strides recorded and those found; the offset.

    off_frames : (boundaries judged,) how far each is from its strike, the offset taken off
    """

    right: int
    judged: int
    strides_found: int
    strides: int
    offset: float
    off_frames: np.ndarray


def judged(
    boundary: np.ndarray, contact: np.ndarray, tolerance: float = TOLERANCE_FRAMES, *, lifts: bool = False
) -> Judged:
    """Boundaries (C + 1,) of C cycles in a row against the strikes of one foot: of the two the one they fit better.

    lifts : against the lifts of each foot too, the best of four kinds of event

    A boundary is any one phase of the cycle; so one constant number of frames, the median difference between the
    boundaries and the strikes nearest to them after a first estimate from their mean phase, is taken off per take.
    A cycle is right where both its boundaries are within ``tolerance`` of two strikes in a row. Boundaries more than
    half a stride before the first or after the last strike have no partner and are not judged. A stride (from strike
    to strike) can be found where it lies within the take after the offset, and is found where both strikes have a
    boundary within ``tolerance``.
    """
    events = [strikes(contact[:, foot]) for foot in (0, 1)]
    events += [strikes(~contact[:, foot]) for foot in (0, 1) if lifts]
    found = [_against(boundary, each, len(contact), tolerance) for each in events]
    return max(found, key=lambda one: (one.right, one.strides_found))


def strikes(bears: np.ndarray) -> np.ndarray:
    """Frames at which the foot begins to bear, flickers left out."""
    bears = np.asarray(bears, int).copy()
    edges = np.concatenate([[0], np.flatnonzero(np.diff(bears)) + 1, [len(bears)]])
    for start, stop in pairwise(edges[1:-1]):
        if stop - start < SHORTEST_FRAMES:
            bears[start:stop] = bears[start - 1]
    return np.flatnonzero(np.diff(bears) == 1) + 1


def _against(boundary: np.ndarray, events: np.ndarray, n_frames: int, tolerance: float) -> Judged:
    if len(events) < 2 or len(boundary) < 2:
        return Judged(0, 0, 0, max(len(events) - 1, 0), np.nan, np.zeros(0))
    stride = float(np.median(np.diff(events)))
    phase = np.interp(boundary, events, np.arange(len(events))) % 1.0
    first = np.angle(np.mean(np.exp(2j * np.pi * phase))) / (2 * np.pi) * stride
    partner = np.argmin(np.abs(boundary[:, None] - first - events), axis=1)
    offset = float(np.median(boundary - events[partner]))
    partner = np.argmin(np.abs(boundary[:, None] - offset - events), axis=1)
    off = boundary - offset - events[partner]
    has_one = np.abs(off) < stride / 2
    both = has_one[1:] & has_one[:-1]
    near = np.abs(off) <= tolerance
    right = both & near[1:] & near[:-1] & (np.diff(partner) == 1)
    within = (events + offset >= 0) & (events + offset <= n_frames - 1)
    met = np.isin(np.arange(len(events)), partner[near])
    possible = within[1:] & within[:-1]
    return Judged(
        int(right.sum()),
        int(both.sum()),
        int((possible & met[1:] & met[:-1]).sum()),
        int(possible.sum()),
        offset,
        np.abs(off[has_one]),
    )
