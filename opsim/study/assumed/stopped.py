"""What is assumed of stations that break down or are maintained."""

from collections.abc import Iterator

from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.failures import BUSY, CLOCK, CYCLES, NO_TEAM

_COUNTED = {
    CLOCK: "while the station is up, in work or not",
    BUSY: "only while something is done there",
    CYCLES: "by operations, and it stops as the next one would begin",
}


def stopped(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of every kind of stop that the plan has."""
    for by, counted in _COUNTED.items():
        names = [one.name for one in plan.breakdowns if one.by == by]
        if names:
            yield "breakdowns", f"{listed(names)}: what leads to it counts {counted}"
    if plan.stops:
        yield (
            "breakdowns",
            "a stop stops all servers of a station; one stop at a time, and what falls due meanwhile follows; a "
            "station that stands neither wears nor breaks down",
        )
    for fate, words in (("restart", "begins anew, with a time of its own"), ("scrap", "is scrap")):
        names = [one.name for one in plan.breakdowns if one.job == fate]
        if names:
            yield "breakdowns", f"{listed(names)}: what was in work {words}"
    alone = [one.name for one in plan.stops if one.team == NO_TEAM]
    if alone:
        yield "breakdowns", f"{listed(alone)}: ends by itself after its time; no worker and no team is needed"
    if plan.repair_teams:
        yield "breakdowns", "a repair team comes without a walk, to the stop that waits longest; it knows no other work"
