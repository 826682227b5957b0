"""A seam between two courses: what differs there is spread over both sides, so that value and rate are continuous.

A course is brought to the common value by an offset that grows to the seam with a quintic ease (offset decay); at the
seam both sides have the value half-way and the mean of both rates. Directions are turned, so they stay unit vectors.
Source: Bollo, Inertialization (GDC 2018); Shin, Kim & Park, On-line motion blending (2003). Ours is two-sided.

A course of postures over the floor, and the seam between two: where they meet, and how long it takes them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from emulator.geometry import sphere
from emulator.skeleton import Skeleton

PEAK = 1.875
"""The quintic ease's greatest slope."""


@dataclass(frozen=True, eq=False)
class End:
    """Where a course is at one of its ends: ``value`` and ``rate`` per second, and what of the rate is not certain.

    directions: (n, B, 3) each, ``doubt`` (n, B); plain channels: (n, C) each, ``doubt`` (n, C).
    """

    value: np.ndarray
    rate: np.ndarray
    doubt: np.ndarray


@dataclass(frozen=True, eq=False)
class Offset:
    """What one side is moved by: ``shift`` at the seam, ``rate`` the change of its rate there; both as ``End.value``.

    Of directions both are vectors to turn by, in radians (per second).
    """

    shift: np.ndarray
    rate: np.ndarray


def ease(share: np.ndarray) -> np.ndarray:
    """0 to 1 over ``share`` from 0 to 1, slope and bend 0 at both ends; 0 below."""
    s = np.clip(share, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


def ease_rate(share: np.ndarray) -> np.ndarray:
    """0 at both ends, slope 1 at 1, else slope and bend 0: what changes a rate at the seam and no value; 0 below."""
    s = np.clip(share, 0.0, 1.0)
    return s**3 * (-4.0 + 7.0 * s - 3.0 * s**2)


def end_of(values: np.ndarray, time_s: np.ndarray, *, last: bool, unit: bool = False, within_s: float = 0.3) -> End:
    """The last or first End of courses (n, T, ...) at times (n, T), its rate by the difference to the next frame.

    unit : the values are unit vectors (n, T, B, 3), their rates tangent.
    The doubt is the largest change of the rate from frame to frame within ``within_s`` of the end: a jump at a seam
    that is no larger is what these courses do all the time, and is left; so two halves of a course give it back.
    """
    if last:
        values, time_s = values[:, ::-1], time_s[:, ::-1]
    away_s = np.abs(time_s - time_s[:, :1])
    n_near = max(3, int((away_s <= within_s).sum(axis=1).max(initial=0)))
    near, wide = values[:, :n_near], (slice(None), slice(None), *[None] * (values.ndim - 2))
    rates = np.diff(near, axis=1) / np.diff(time_s[:, :n_near], axis=1)[wide]
    here, rate, change = values[:, 0], rates[:, 0], np.diff(rates, axis=1)
    if unit:
        rate = rate - np.sum(rate * here, axis=-1, keepdims=True) * here
        change = np.linalg.norm(change, axis=-1)
    close = away_s[:, 2:n_near] <= within_s
    close = close[(slice(None), slice(None), *[None] * (change.ndim - 2))]
    return End(here, rate, np.max(np.where(close, np.abs(change), 0.0), axis=1, initial=0.0))


def gap_rad(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """How far two postures (..., B, 3) are apart: the angle of the bone that differs most, (...) radians."""
    return np.asarray(sphere.angle(before, after).max(-1))


def turns(before: End, after: End) -> tuple[Offset, Offset]:
    """What brings the directions at the end of ``before`` and at the start of ``after`` to the same value and rate.

    Opposite bones meet half-way by one of the ways there are.
    """
    axis = _axis(before.value, after.value) * (0.5 * sphere.angle(before.value, after.value))[..., None]
    common = sphere.turned(before.value, axis)
    rates = sphere.turned(before.rate, axis), sphere.turned(after.rate, -axis)
    missing = rates[1] - rates[0]
    length = np.linalg.norm(missing, axis=-1)
    missing = missing * _beyond(length, np.maximum(before.doubt, after.doubt))[..., None]
    change = np.cross(common, 0.5 * missing)
    return Offset(axis, change), Offset(-axis, -change)


def shifts(before: End, after: End) -> tuple[Offset, Offset]:
    """The same for plain channels."""
    shift, missing = 0.5 * (after.value - before.value), after.rate - before.rate
    change = 0.5 * missing * _beyond(np.abs(missing), np.maximum(before.doubt, after.doubt))
    return Offset(shift, change), Offset(-shift, -change)


def eased_turn(directions: np.ndarray, offset: Offset, to_seam_s: np.ndarray, window_s: np.ndarray) -> np.ndarray:
    """Directions (n, T, B, 3) under an Offset: ``to_seam_s`` (n, T) from there to the seam, negative beyond it.

    window_s : (n,) how long before (or after) the seam the offset begins (ends).
    """
    share, rate = _weights(to_seam_s, window_s)
    rows, columns = np.nonzero((share > 0) & np.any(offset.shift != 0, axis=(1, 2))[:, None] | (rate != 0))
    out = np.array(directions)
    some = sphere.turned(out[rows, columns], share[rows, columns, None, None] * offset.shift[rows])
    out[rows, columns] = sphere.turned(some, rate[rows, columns, None, None] * offset.rate[rows])
    return out


def eased_shift(values: np.ndarray, offset: Offset, to_seam_s: np.ndarray, window_s: np.ndarray) -> np.ndarray:
    """The same for plain channels (n, T, C)."""
    share, rate = _weights(to_seam_s, window_s)
    return np.asarray(values + share[..., None] * offset.shift[:, None] + rate[..., None] * offset.rate[:, None])


def _weights(to_seam_s: np.ndarray, window_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    share = 1.0 - np.abs(to_seam_s) / window_s[:, None]
    sign = np.where(to_seam_s < 0, -1.0, 1.0)
    return ease(share), sign * window_s[:, None] * ease_rate(share)


def _axis(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Unit vectors (..., 3) about which p is turned to q; 0 where they agree, some one across where opposite."""
    across = np.cross(p, q)
    length = np.linalg.norm(across, axis=-1, keepdims=True)
    some = np.where(np.sum(p * q, axis=-1, keepdims=True) < 0, sphere.basis(p)[..., 0, :], 0.0)
    return np.where(length > 1e-12, across / np.where(length > 1e-12, length, 1.0), some)


def _beyond(length: np.ndarray, doubt: np.ndarray) -> np.ndarray:
    """The share of a difference that is not explained by its doubt."""
    return np.maximum(0.0, 1.0 - doubt / np.where(length > 0, length, 1.0)) * (length > 0)


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


Offsets = tuple[Offset, Offset]
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
        directions = (end_of(c.directions, c.time_s, last=c is before, unit=True) for c in (before, after))
        turn = turns(*directions)
    headings = (end_of(c.yaw_rad[..., None], c.time_s, last=c is before) for c in (before, after))
    level = (replace(end, value=np.zeros_like(end.value)) for end in headings)  # the next goes on where this looks
    return Seam(turn, shifts(*level), window_s)


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
    return 2 * FASTEST_RAD_PER_S * blend_s / PEAK


def unhurried_s(gap_rad: np.ndarray, blend_s: float = BLEND_S) -> np.ndarray:
    """(n,) the blend that a gap needs for no bone to be turned faster than FASTEST_RAD_PER_S; ``blend_s`` or more."""
    return np.maximum(blend_s, PEAK * np.asarray(gap_rad) / (2 * FASTEST_RAD_PER_S))
