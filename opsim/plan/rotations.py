"""Job rotation: who is at which post, and what makes people change."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RotationPlan:
    """workers : ranks in the order of the list; posts : ranks of the stations of each post

    every_s : by clock; after : by count of performances; rule : by a rule; the others are None
    """

    name: str
    workers: tuple[int, ...]
    posts: tuple[tuple[int, ...], ...]
    every_s: float | None = None
    after: int | None = None
    rule: str | None = None


def plan_rotations(scenario, ranks) -> tuple[RotationPlan, ...]:
    """All rotations in natural order of names."""
    return ()
