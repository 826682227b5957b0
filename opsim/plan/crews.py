"""Crews: people who share a line by a rule of their own."""

from dataclasses import dataclass

BUCKET_BRIGADE, RABBIT_CHASE = "bucket_brigade", "rabbit_chase"


@dataclass(frozen=True, slots=True)
class CrewPlan:
    """stations : ranks in the order of the line; workers : ranks, in a bucket brigade from the line's start on."""

    name: str
    kind: str
    stations: tuple[int, ...]
    workers: tuple[int, ...]


def plan_crews(scenario, ranks) -> tuple[CrewPlan, ...]:
    """All crews in natural order of names."""
    return ()
