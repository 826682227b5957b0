"""Crews: people who share a line by a rule of their own."""

from dataclasses import dataclass

from opsim.names import natural_key
from opsim.plan.ranks import Ranks, ranked

BUCKET_BRIGADE, RABBIT_CHASE = "bucket_brigade", "rabbit_chase"


@dataclass(frozen=True, slots=True)
class CrewPlan:
    """stations, workers : ranks, in the order of the line; of a brigade, from who begins jobs to who ends them."""

    name: str
    kind: str
    stations: tuple[int, ...]
    workers: tuple[int, ...]


def plan_crews(scenario, ranks: Ranks) -> tuple[CrewPlan, ...]:
    """All crews in natural order of names."""
    people = ranked(scenario.workers)
    return tuple(
        CrewPlan(
            name,
            crew.kind,
            tuple(ranks.stations[station] for station in crew.stations),
            tuple(people[worker] for worker in crew.workers),
        )
        for name, crew in sorted(scenario.crews.items(), key=lambda item: natural_key(item[0]))
    )
