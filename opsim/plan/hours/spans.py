"""Arithmetic of times: (from_s, to_s) pairs in order, none of which touch."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

Spans = tuple[tuple[float, float], ...]


def at_least(n: int, several: Iterable[Spans]) -> Spans:
    """When at least n of several are there at once; n = 1: when any of them is."""
    found: list[tuple[float, float]] = []
    for start_s, end_s, n_there in _counted(several):
        if n_there >= n:
            if found and found[-1][1] == start_s:
                found[-1] = found[-1][0], end_s
            else:
                found.append((start_s, end_s))
    return tuple(found)


def either(*several: Spans) -> Spans:
    """When any of them is."""
    return at_least(1, several)


def both(one: Spans, other: Spans) -> Spans:
    """When both are."""
    return at_least(2, (one, other))


def without(one: Spans, other: Spans) -> Spans:
    """When the one is and the other is not."""
    found, number = [], 0
    for start_s, end_s in one:
        while number < len(other) and other[number][1] <= start_s:
            number += 1
        here = number
        while here < len(other) and other[here][0] < end_s:
            if start_s < other[here][0]:
                found.append((start_s, other[here][0]))
            start_s = other[here][1]
            here += 1
        if start_s < end_s:
            found.append((start_s, end_s))
    return tuple(found)


def total_s(spans: Spans) -> float:
    """How long all of them are together."""
    return sum(end_s - start_s for start_s, end_s in spans)


def together(several: Iterable[Spans]) -> Iterator[tuple[float, float, frozenset[int]]]:
    """(from_s, to_s, the numbers of those who are there) from each change to the next, where anybody is."""
    changes: dict[float, set[int]] = {}
    for number, spans in enumerate(several):
        for start_s, end_s in spans:
            for time_s in (start_s, end_s):
                changes.setdefault(time_s, set()).symmetric_difference_update({number})
    there: set[int] = set()
    times = sorted(changes)
    for start_s, end_s in pairwise(times):
        there ^= changes[start_s]
        if there:
            yield start_s, end_s, frozenset(there)


def _counted(several: Iterable[Spans]) -> Iterator[tuple[float, float, int]]:
    """(from_s, to_s, how many are there) from each change to the next."""
    changes: dict[float, int] = {}
    for spans in several:
        for start_s, end_s in spans:
            if start_s < end_s:
                changes[start_s] = changes.get(start_s, 0) + 1
                changes[end_s] = changes.get(end_s, 0) - 1
    n_there, times = 0, sorted(changes)
    for start_s, end_s in pairwise(times):
        n_there += changes[start_s]
        yield start_s, end_s, n_there
