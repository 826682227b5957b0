"""What lies between two plain values of a scenario: numbers, quantities with their unit, and lists of them."""

from __future__ import annotations

import math
import re
from typing import Any

from opsim.problems import shown

_QUANTITY = re.compile(
    r"\s*([-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*([^\W\d_]+(?:/[^\W\d_]+)?|\u00b0)\s*"
)
_STEPS = 4
"""Digits of a range that a value in it is written with: finer ones would show how it was computed, and no more."""


class NotARange(ValueError):
    """Two values between which nothing lies: ``message`` in plain words, ``hint`` the way out."""

    def __init__(self, message: str, hint: str = ""):
        super().__init__(f"{message}; {hint}" if hint else message)
        self.message, self.hint = message, hint


def number_of(value: Any) -> tuple[float, str] | None:
    """(number, unit) of a plain value, ``""`` where it has no unit; None where it is no number: ``"40 s"``, 4."""
    if isinstance(value, bool):
        return None
    if isinstance(value, int | float):
        return (float(value), "") if math.isfinite(value) else None
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    return None if match is None else (float(match[1]), match[2])


def is_whole(low: Any, high: Any) -> bool:
    """Whether only whole numbers lie between two values."""
    return all(isinstance(end, int) and not isinstance(end, bool) for end in (low, high))


def check_range(low: Any, high: Any) -> None:
    """Raises NotARange where nothing lies between two values, or they are not in order."""
    if isinstance(low, list) and isinstance(high, list):
        _check_lists(low, high)
        return
    (first, unit), (last, other) = _known(low), _known(high)
    if unit != other:
        said = [f"'{one}'" if one else "no unit" for one in (unit, other)]
        raise NotARange(f"the ends of a range need the same unit, found {said[0]} and {said[1]}", "write both alike")
    if not first < last:
        what = "are the same" if first == last else "are the wrong way round"
        raise NotARange(f"the ends of the range, {shown(low)} and {shown(high)}, {what}", "the lower one comes first")


def between(low: Any, high: Any, share: float) -> Any:
    """The value at a share of the way, from 0 (low) to 1 (high), as a file has it: ``52.5 s``, ``[7 m, 1 m]``.

    Between whole numbers every one of them has the same part of the way.
    """
    if isinstance(low, list):
        return [_way(a, b, share) for a, b in zip(low, high)]
    if is_whole(low, high):
        return min(high, low + math.floor(share * (high - low + 1)))
    if share in (0, 1):
        return high if share else low
    (first, unit), (last, _) = _known(low), _known(high)
    number = round(first + share * (last - first), _STEPS - math.floor(math.log10(last - first)))
    number = min(max(number, first), last)  # an end may have more digits than what lies in between
    return f"{number:.12g} {unit}" if unit else number


def _way(a: Any, b: Any, share: float) -> Any:
    """Of a part of a list, which may also go down."""
    if a == b:
        return a
    return between(a, b, share) if _known(a)[0] < _known(b)[0] else between(b, a, 1 - share)


def steps(low: Any, high: Any, levels: int) -> list[Any]:
    """So many values at even steps, both ends among them; of whole numbers no more than there are."""
    if is_whole(low, high):
        found = [low + round(k * (high - low) / (levels - 1)) for k in range(levels)]
        return list(dict.fromkeys(found))
    return [between(low, high, k / (levels - 1)) for k in range(levels)]


def _known(end: Any) -> tuple[float, str]:
    found = number_of(end)
    if found is None:
        hint = "a range goes between numbers, or quantities with one unit such as '90 s'; others are given as a list"
        raise NotARange(f"{shown(end)} cannot be the end of a range", hint)
    return found


def _check_lists(low: list[Any], high: list[Any]) -> None:
    if len(low) != len(high):
        raise NotARange(f"the ends of a range need to be alike, found lists of {len(low)} and {len(high)}")
    if low == high:
        raise NotARange("the ends of the range are the same")
    for a, b in zip(low, high):
        if a != b:
            check_range(*sorted((a, b), key=lambda end: _known(end)[0]))
