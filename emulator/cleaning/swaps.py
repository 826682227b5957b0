"""Swaps: two joints exchange their names, such as the left and the right wrist, and often back again.

Found by continuity: from one frame to the next each goes on where the other was. Which stretch is the swapped one is
told by the bones: the one in which they fit the rest of the take worse; where they do not tell, the shorter one.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from emulator.cleaning.bridge import neighbours
from emulator.cleaning.found import Repair
from emulator.cleaning.settings import CleaningSettings
from emulator.recordings.take import Take

CROSSED = 0.5
"""A crossed way is at most this share of the straight one."""
TELLING_M = 0.01
"""Bones tell which stretch is swapped where their mean misfit differs by this much."""


def without_swaps(take: Take, settings: CleaningSettings) -> tuple[Take, tuple[Repair, ...]]:
    """The take with mirrored joints (left_..., right_...) under their own names; size is how far they were apart, m."""
    if settings.swaps == "off":
        return take, ()
    positions, repairs = take.positions_m.copy(), []
    for left, right in mirrored(take.names):
        at = _exchanges(positions[:, left], positions[:, right], settings.least_swap_m)
        if not at:
            continue
        for first, last in _swapped(take, left, right, at):
            apart = float(
                np.nanmedian(
                    np.linalg.norm(positions[first : last + 1, left] - positions[first : last + 1, right], axis=-1)
                )
            )
            repairs.append(_repair(take, (left, right), first, last, apart, settings.swaps == "mend"))
            positions[first : last + 1, [left, right]] = positions[first : last + 1, [right, left]]
    mended = settings.swaps == "mend" and bool(repairs)
    return replace(take, positions_m=positions) if mended else take, tuple(repairs)


def mirrored(names: tuple[str, ...]) -> list[tuple[int, int]]:
    """Joint numbers of each left joint with its right one."""
    return [
        (number, names.index(other))
        for number, name in enumerate(names)
        if name.startswith("left_") and (other := f"right_{name.removeprefix('left_')}") in names
    ]


def _exchanges(one: np.ndarray, other: np.ndarray, least_m: float) -> list[int]:
    """First frames (after a gap, too) at which each goes on where the other was, at least ``least_m`` away."""
    seen = np.flatnonzero(np.isfinite(one).all(axis=-1) & np.isfinite(other).all(axis=-1))
    if len(seen) < 2:
        return []
    a, b = one[seen], other[seen]
    straight = np.linalg.norm(a[1:] - a[:-1], axis=-1) + np.linalg.norm(b[1:] - b[:-1], axis=-1)
    crossed = np.linalg.norm(a[1:] - b[:-1], axis=-1) + np.linalg.norm(b[1:] - a[:-1], axis=-1)
    return seen[1:][(crossed < CROSSED * straight) & (straight > 2 * least_m)].tolist()


def _swapped(take: Take, left: int, right: int, at: list[int]) -> list[tuple[int, int]]:
    """(first, last) of the swapped stretches: every other one between the exchanges."""
    edges = [0, *at, take.n_frames]
    stretches = [(start, stop - 1) for start, stop in pairwise(edges)]
    even, odd = stretches[0::2], stretches[1::2]
    misfit = _misfit(take, left, right, even), _misfit(take, left, right, odd)
    if abs(misfit[0] - misfit[1]) > TELLING_M:
        return odd if misfit[1] > misfit[0] else even
    return odd if _length(odd) <= _length(even) else even


def _misfit(take: Take, left: int, right: int, stretches: list[tuple[int, int]]) -> float:
    """How much longer, on average, the bones to the two joints are than if they were exchanged; 0 without bones."""
    if take.parents is None:
        return 0.0
    frames = np.concatenate([np.arange(first, last + 1) for first, last in stretches])
    total = [0.0, 0.0]
    for way, pair in enumerate(((left, right), (right, left))):
        for joint, stand_in in zip((left, right), pair):
            for other in neighbours(take, joint):
                bone = take.positions_m[frames, stand_in] - take.positions_m[frames, other]
                total[way] += float(np.nanmean(np.linalg.norm(bone, axis=-1)))
    return total[0] - total[1]


def _length(stretches: list[tuple[int, int]]) -> int:
    return sum(last - first + 1 for first, last in stretches)


def _repair(take: Take, pair: tuple[int, int], first: int, last: int, apart: float, mended: bool) -> Repair:
    words = f"exchange places, {100 * apart:.1f} cm apart; {'put back' if mended else 'left as it is'}"
    joints = tuple(take.names[joint] for joint in pair)
    return Repair(take.name, "swap", joints, first, last, apart, "m", words, mended, bad=not mended)
