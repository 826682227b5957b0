"""Lines along the axes of a floor, laid one after the other, each a little beside those that are there already."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import hypot, inf

import numpy as np

Point = tuple[float, float]
BESIDE = (0.0, 7.0, -7.0, 13.0, -13.0)
"""Pixels that a line may run beside the straight way."""
THROUGH, NEAR, OFF = 60.0, 2.0, 1.5
"""What running through a mark costs, and a pixel beside the straight way, in pixels of hidden line; free space kept."""


class Laid:
    """Lines of people's ways. marks : (M, 2) middles of what stands on the floor, half_px : of a mark

    Of the two ways round the corner, and of some lanes beside each, the one is taken that hides least.
    """

    def __init__(self, marks: Sequence[Point], half_px: float) -> None:
        self._marks = np.array(marks, dtype=float).reshape(-1, 2)
        self._half = half_px
        self._drawn: tuple[list[tuple[float, ...]], list[tuple[float, ...]]] = ([], [])

    def line(self, start: Point, end: Point, width: float) -> list[Point]:
        """The corners of a line, which is drawn from now on."""
        drawn = tuple(np.array(pieces, dtype=float).reshape(-1, 4) for pieces in self._drawn)
        apart = (np.abs(self._marks - start).max(axis=1) > 1) & (np.abs(self._marks - end).max(axis=1) > 1)
        others, best, least = self._marks[apart], [start, end], inf
        for beside, corners in _offers(start, end):
            if OFF * abs(beside) >= least:  # NOTE: what lies further beside cannot be better
                break
            cost = OFF * abs(beside) + self._hidden(corners, width, drawn, others)
            if cost < least - 1e-6:
                best, least = corners, cost
        for axis, across, low, high in _pieces(best):
            self._drawn[axis].append((across, low, high, width))
        return best

    def _hidden(self, corners: Sequence[Point], width: float, drawn: Sequence[np.ndarray], others: np.ndarray) -> float:
        hidden = 0.0
        for axis, across, low, high in _pieces(corners):
            there = drawn[axis]
            shared = np.minimum(high, there[:, 2]) - np.maximum(low, there[:, 1])
            near = 1 - np.abs(there[:, 0] - across) / ((width + there[:, 3]) / 2 + NEAR)
            hidden += float((shared.clip(0.0) * near.clip(0.0)).sum())
            half = self._half + width / 2
            beside = np.abs(others[:, 1 - axis] - across) < half
            hidden += THROUGH * int((beside & (others[:, axis] > low - half) & (others[:, axis] < high + half)).sum())
        return hidden


def _offers(start: Point, end: Point) -> Iterator[tuple[float, list[Point]]]:
    """(how far beside, corners)"""
    (x, y), (u, v) = start, end
    for o in BESIDE:
        if abs(y - v) < 1:
            yield o, _plain([(x, y), (x, y + o), (u, y + o), (u, v)])
        elif abs(x - u) < 1:
            yield o, _plain([(x, y), (x + o, y), (x + o, v), (u, v)])
        else:
            yield o, _plain([(x, y), (x, y + o), (u + o, y + o), (u + o, v), (u, v)])
            yield o, _plain([(x, y), (x + o, y), (x + o, v + o), (u, v + o), (u, v)])


def _plain(corners: Sequence[Point]) -> list[Point]:
    """Without corners at which nothing turns."""
    return [corner for before, corner in pairwise([None, *corners]) if corner != before and corner is not None]


def _pieces(corners: Sequence[Point]) -> Iterator[tuple[int, float, float, float]]:
    """(axis along which it runs, where across, from, to) of each piece."""
    for a, b in pairwise(corners):
        axis = 0 if abs(b[0] - a[0]) >= abs(b[1] - a[1]) else 1
        yield axis, a[1 - axis], min(a[axis], b[axis]), max(a[axis], b[axis])


def rounded(corners: Sequence[Point], most: float = 8.0) -> str:
    """The ``d`` of a path through corners, each a little rounded."""
    drawn = "M{:.1f} {:.1f}".format(*corners[0])
    for a, b, c in zip(corners, corners[1:], corners[2:]):
        before, after = (_towards(b, other, most) for other in (a, c))
        drawn += "L{:.1f} {:.1f}Q{:.1f} {:.1f} {:.1f} {:.1f}".format(*before, *b, *after)
    return drawn + "L{:.1f} {:.1f}".format(*corners[-1])


def _towards(start: Point, end: Point, most: float) -> Point:
    """So far on the way, but at most half of it."""
    long = hypot(end[0] - start[0], end[1] - start[1])
    part = min(most / long, 0.5) if long else 0.0
    return start[0] + (end[0] - start[0]) * part, start[1] + (end[1] - start[1]) * part
