"""What the scoring functions are asked, checked: every mistake at once."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import isfinite
from numbers import Real

from opsim.problems import did_you_mean, shown


def angles_checked(words: Iterable[str] = (), **numbers: float) -> dict[str, float]:
    """The numbers. Raises one ValueError with a line for each that is none, and for each mistake among ``words``."""
    mistakes = [
        f"{name}: found {shown(value)}, expected a number" for name, value in numbers.items() if not _number(value)
    ]
    mistakes += [
        f"{name}: found {value:g}, expected 0 or more"
        for name, value in numbers.items()
        if name.endswith("_kg") and _number(value) and value < 0
    ]
    mistakes += words
    if mistakes:
        raise ValueError("\n".join(mistakes))
    return numbers


def choice_checked(name: str, value: object, known: Sequence) -> list[str]:
    """Nothing, or what is wrong with a word."""
    if value in known:
        return []
    if not isinstance(known[0], str):
        return [f"{name}: found {shown(value)}, expected one of {', '.join(map(str, known))}"]
    return [f"{name}: no {shown(value)}; {did_you_mean(value, known)}"]


def _number(value: object) -> bool:
    return isinstance(value, Real) and isfinite(value)
