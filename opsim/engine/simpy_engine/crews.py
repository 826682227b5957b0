"""Crews: bucket brigades and rabbit chases, whose members go with their jobs along a line."""

from functools import partial

from opsim.engine.simpy_engine.crew import Crew
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import CREWS

COMES, DONE = -10, 90
"""Among the preparations of a job the first; among what is asked when an operation is done the last."""


def install(floor: Floor) -> None:
    """The members of each crew are sent by it; that nobody else serves its stations is in their ratings."""
    crews = [Crew(floor, plan) for plan in floor.plan.crews]
    for rank in {rank for plan in floor.plan.crews for rank in plan.workers}:
        floor.workers[rank].restrict(CREWS, 0)
    for crew in crews:
        for station in crew.stations:
            station.add_stage(COMES, crew.line.came)
            station.add_after(DONE, partial(Crew.done, crew))
        crew.line.guard()
        floor.dispatchers.append(crew.dispatch)
