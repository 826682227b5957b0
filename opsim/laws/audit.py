"""All laws of an event log: nothing lost, nobody in two places, no gap, nothing where there is no room for it."""

from collections.abc import Callable, Iterator
from itertools import chain

from opsim.laws.jobs import Stays, conserved, integral, one_state, places, progress, tiled
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.plugins.registry import subjects_of
from opsim.subjects.breakdowns.figures import one_outage_at_a_time, repair_teams_in_use
from opsim.subjects.human.figures import pace, rests, shifts
from opsim.subjects.material.figures import cards_in_use
from opsim.subjects.shifts.laws import away, closed, duty
from opsim.subjects.stations.figures import rooms
from opsim.subjects.tasks.figures import heights
from opsim.subjects.tools.figures import tools_in_use
from opsim.subjects.transport.figures import vehicles_in_use

Law = Callable[[EventLog, Plan, Stays], Iterator[str]]


def shared(log: EventLog, plan: Plan, stays: Stays) -> Iterator[str]:
    """Everything that several ask for and only so many can have."""
    yield from tools_in_use(log, plan)
    yield from repair_teams_in_use(log, plan)
    yield from vehicles_in_use(log, plan)
    yield from cards_in_use(plan, stays)


LAWS: dict[str, Law] = {
    "every job created is finished, scrapped, joined, split, lost or inside": conserved,
    "a worker is in exactly one state at any time": one_state,
    "a job's rows tile its stay without gap": tiled,
    "time of jobs' rows in the window equals the integral of jobs inside": integral,
    "no station, store or conveyor holds more jobs than it has room for": rooms,
    "every second of every worker has a place, and nobody moves but by walking": places,
    "people work in their shifts, and after them only for what they stay for": duty,
    "a job waits for one worker only while he is away": away,
    "the pieces of a performance follow one another and add up to one": progress,
    "nobody works at a station that is down": one_outage_at_a_time,
    "nothing begins at a station that its calendar closes": closed,
    "no more tools, cards, repair teams and vehicles are in use than there are": shared,
    "hands are at the height that the product, or the layer in turn, asks for": heights,
    "who learns, or goes at another pace, takes what was drawn for him times what that makes of it": pace,
    "a time is shifted by as much as the worker's day has tired him": shifts,
    "who rests by need was too tired, and rests for as long as it takes": rests,
}
"""Each law yields what it finds wrong, in words; nothing where the log obeys it."""
CHECKS = tuple(LAWS)


class BrokenLog(AssertionError):
    """An event log that contradicts itself; the message names the first contradiction found."""


def audit(log: EventLog, plan: Plan) -> tuple[str, ...]:
    """Check a log against all laws and return ``checks_of(plan)``. Raises BrokenLog, naming what is wrong."""
    stays = Stays(log)
    ours = (law(log, plan, stays) for law in LAWS.values())
    theirs = (law(log, plan, part) for subject, part in subjects_of(plan) for law in subject.laws.values())
    for complaint in chain.from_iterable(chain(ours, theirs)):
        raise BrokenLog(f"replication {log.replication}: {complaint}")
    return checks_of(plan)


def checks_of(plan: Plan) -> tuple[str, ...]:
    """The sentences of all laws that a log of a plan is checked against."""
    return (*CHECKS, *(sentence for subject, _ in subjects_of(plan) for sentence in subject.laws))
