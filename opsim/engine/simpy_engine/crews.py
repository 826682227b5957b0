"""Crews: bucket brigades and rabbit chases, whose members go with their jobs along a line."""

from functools import partial

from opsim.engine.simpy_engine.crew import Crew
from opsim.engine.simpy_engine.floor import Floor

COMES, DONE = -10, 90
"""Among the preparations of a job the first; among what is asked when an operation is done the last."""
MEMBER, NO_MEMBER = "crews", "the crews of others"
"""The limits of who is in a crew, sent by his crew alone, and of who is in none."""


def install(floor: Floor) -> None:
    """The members of each crew serve its stations, and nobody else does."""
    if not floor.plan.crews:
        return
    crews = [Crew(floor, plan) for plan in floor.plan.crews]
    members = {rank for plan in floor.plan.crews for rank in plan.workers}
    theirs = sum(1 << rank for plan in floor.plan.crews for rank in plan.stations)
    for worker in floor.workers:
        if worker.rank in members:
            worker.restrict(MEMBER, 0)
        else:
            worker.restrict(NO_MEMBER, ~theirs)
    for crew in crews:
        for station in crew.stations:
            station.add_stage(COMES, crew.line.came)
            station.add_after(DONE, partial(Crew.done, crew))
        crew.line.guard()
        floor.dispatchers.append(crew.dispatch)
