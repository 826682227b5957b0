"""The time of day on the floor: a shift of every log time that a worker draws himself."""

from __future__ import annotations

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Station, Worker


def install(floor: Floor) -> None:
    """A shift at every worker, where the time of day counts."""
    circadian, start_s = floor.plan.human.circadian, floor.plan.human.start_s
    if circadian is None:
        return

    def shift(floor: Floor, _worker: Worker, _station: Station, _task: int, _k: int) -> float:
        return circadian.shift(start_s + floor.now)

    for human in floor.humans:
        human.shifts.append(shift)
