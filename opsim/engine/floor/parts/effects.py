"""Where human effects are asked and told: by lines of the floor, so that others need none of their steps."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined
from opsim.engine.floor.parts.state import Floor, Station, Worker
from opsim.engine.floor.parts.stretches import end_stretch


@inlined
def human_drawn(floor: Floor, station: Station, worker: Worker, task: int, k: int, drawn_s: float) -> float:
    """His own next time as it is now, by ``humans.drawn``; ``worker.pace_shift`` is the shift of log time."""
    floor.asked_task, floor.asked_k, floor.asked_s = task, k, drawn_s
    floor.drawn_line(floor, worker, station)
    return floor.asked_s


@inlined
def works(floor: Floor, worker: Worker, task: int, until_s: float, done: float, k: int) -> None:
    """He works from now until then, if nothing comes between; ``done`` of it was done before."""
    if worker.human:
        floor.asked_task, floor.asked_k, floor.asked_until_s, floor.asked_done = task, k, until_s, done
        floor.works_line(floor, worker)


@inlined
def stops(floor: Floor, worker: Worker) -> None:
    """What he worked on is broken off, or waits for something."""
    if worker.human:
        floor.stops_line(floor, worker)


@inlined
def stop(floor: Floor, worker: Worker) -> None:
    """The stretch under way means nothing any more."""
    end_stretch(floor, worker)
    stops(floor, worker)
