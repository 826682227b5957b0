"""Paced lines: stations whose jobs move together."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LinePlan:
    """stations : ranks, in the order of the line."""

    name: str
    kind: str
    stations: tuple[int, ...]
    takt_s: float


def plan_lines(scenario, ranks) -> tuple[LinePlan, ...]:
    """All paced lines in natural order of names."""
    return ()
