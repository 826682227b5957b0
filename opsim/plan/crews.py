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


def kept_from(worker: str, scenario) -> set[str]:
    """Stations where somebody does not work, skill or not: those of crews he is not in, and of a member all others."""
    theirs = {station for crew in scenario.crews.values() for station in crew.stations}
    own = {station for crew in scenario.crews.values() if worker in crew.workers for station in crew.stations}
    return set(scenario.stations) - own if own else theirs


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
