"""What ``opsim motion score`` scores: movements, their necks' neutral, when hands are full."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, eq=False)
class Source:
    """What is scored, in words, on which skeleton, and where the neutral of necks comes from.

    movements : ``opsim.ergonomics.shift.movement.Movement`` each;  notes : what is missing or odd, in sentences
    walking   : whether they are steps of somebody who walks
    mark_names, seen_names : marks of the movements, and joints that are seen at some time
    """

    title: str
    skeleton: Any
    movements: list[Any]
    neck_neutral_rad: float
    neutral_said: str
    notes: tuple[str, ...] = ()
    walking: bool = False
    mark_names: tuple[str, ...] = ()
    seen_names: tuple[str, ...] = ()


def between(progress: Any, moments: tuple[float, float]) -> Any:
    """(N,) whether hands may be full: from one share to another; all before and after a mark that is not known."""
    start, end = moments
    return ~(progress < start) & ~(progress >= end)


def neutral_of(given_rad: float | None, told_rad: float | None, found_from: str) -> tuple[float, str]:
    """The neutral of necks and a sentence whence it is: as given, else as told, else 0."""
    import numpy as np

    if given_rad is not None:
        return given_rad, f"{np.rad2deg(given_rad):.1f} degrees, as given"
    if told_rad is None:
        return 0.0, f"0: not told by {found_from}, as most do not begin upright or have no head; see --neck-neutral"
    return told_rad, f"{np.rad2deg(told_rad):.1f} degrees forward of the trunk, from {found_from}"
