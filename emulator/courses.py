"""A course of postures over the floor, and the seam between two: where they meet, and how long it takes them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from emulator import seams
from emulator.skeleton import Skeleton

BLEND_S = 0.3
FASTEST_RAD_PER_S = 6.0
"""What is spread over a seam turns no bone faster than this: about a shank in walking or a forearm in a quick reach."""


@dataclass(frozen=True, eq=False)
class Course:
    """n courses of one body each: directions (n, T, B, 3) without heading, time_s (n, T) from 0, root_m (n, T, 3) from
    x = y = 0 in the frame of the starting heading, yaw_rad (n, T) from 0, bone_length_m (n, B).

    stretch : (n, T, B) length of each bone over ``bone_length_m``, or None
    """

    directions: np.ndarray
    time_s: np.ndarray
    root_m: np.ndarray
    yaw_rad: np.ndarray
    bone_length_m: np.ndarray
    stretch: np.ndarray | None = None

    @property
    def duration_s(self) -> np.ndarray:
        """(n,) seconds."""
        return np.asarray(self.time_s[:, -1])


Offsets = tuple[seams.Offset, seams.Offset]
Windows = tuple[np.ndarray, np.ndarray]
"""Before and after a seam."""


@dataclass(frozen=True, eq=False)
class Seam:
    """What two courses are moved by where they meet, and how long before and after, (n,) seconds each.

    ``turn`` of the directions, ``yaw`` of the heading (n, 1); each for the course before and the one after.
    """

    turn: Offsets
    yaw: Offsets
    window_s: Windows


def seam_between(before: Course, after: Course, window_s: Windows, turn: Offsets | None = None) -> Seam:
    """The seam of two courses with these windows; ``turn`` where it is known already."""
    if turn is None:
        directions = (seams.end_of(c.directions, c.time_s, last=c is before, unit=True) for c in (before, after))
        turn = seams.turns(*directions)
    headings = (seams.end_of(c.yaw_rad[..., None], c.time_s, last=c is before) for c in (before, after))
    level = (replace(end, value=np.zeros_like(end.value)) for end in headings)  # the next goes on where this looks
    return Seam(turn, seams.shifts(*level), window_s)


def difference(one: Skeleton, other: Skeleton) -> str:
    """How the second skeleton differs from the first, in words."""
    less, more = ([name for name in a.names if name not in b.names] for a, b in ((one, other), (other, one)))
    said = [f"{word} {', '.join(names)}" for word, names in (("no", less), ("also", more)) if names]
    return " and ".join(said) or "the same joints in another order or with other parents"


def windows_s(before_s: np.ndarray, after_s: np.ndarray, blend_s: float | np.ndarray) -> Windows:
    """How long a seam lasts before and after it: ``blend_s``, and at most half of each course (n,)."""
    return np.minimum(blend_s, before_s / 2), np.minimum(blend_s, after_s / 2)


def widest_gap_rad(blend_s: float) -> float:
    """The widest gap that this blend closes with no bone turning faster for it than FASTEST_RAD_PER_S.

    Each side turns by half of it, at the peak 1.875 times as fast as on average: 1.92 rad (110 degrees) for 0.3 s.
    """
    return 2 * FASTEST_RAD_PER_S * blend_s / seams.PEAK


def unhurried_s(gap_rad: np.ndarray, blend_s: float = BLEND_S) -> np.ndarray:
    """(n,) the blend that a gap needs for no bone to be turned faster than FASTEST_RAD_PER_S; ``blend_s`` or more."""
    return np.maximum(blend_s, seams.PEAK * np.asarray(gap_rad) / (2 * FASTEST_RAD_PER_S))
