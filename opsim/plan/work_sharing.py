"""Work sharing: the last tasks of a station, which the next one may do instead."""

from dataclasses import dataclass

from opsim.plan.ranks import Ranks

FILLED = {"half_full": 0.5, "full": 1.0}
"""By word: the share of the next station's buffer from which on a station does the shared work itself."""


@dataclass(frozen=True, slots=True)
class SharePlan:
    """station, partner : ranks of the two; tasks : the last of the first, which may be done first at the other

    In the Plan they are tasks of ``station``, so that loads count them there.

    filled : the share of the partner's buffer from which on the station does them itself
    """

    station: int
    partner: int
    tasks: tuple[int, ...]
    filled: float


def plan_shares(scenario, ranks: Ranks) -> tuple[SharePlan, ...]:
    """All of them in natural order of stations."""
    shares = (
        SharePlan(
            ranks.stations[name],
            ranks.stations[station.share.partner],
            tuple(ranks.tasks[task] for task in station.share.tasks),
            FILLED[station.share.when],
        )
        for name, station in scenario.stations.items()
        if station.share is not None
    )
    return tuple(sorted(shares, key=lambda share: share.station))
