"""What a worker has done of each task, told as it happens. See ``opsim.human.memory``."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined
from opsim.engine.floor.parts.humans import Human
from opsim.engine.floor.parts.state import Floor


@inlined
def memory_works(floor: Floor, human: Human, task: int, k: int, until_s: float) -> None:
    """He works on his k-th of a task from now until then, if nothing comes between."""
    memory_passes(floor, human)
    if human.asked and (human.asked_task != task or human.asked_k != k):
        human.asked = 0  # it came to nothing
    human.busy, human.busy_task, human.busy_from_s, human.busy_until_s = 1, task, floor.now, until_s


@inlined
def memory_stops(floor: Floor, human: Human) -> None:
    """What he worked on is broken off."""
    memory_passes(floor, human)
    human.busy = 0


@inlined
def memory_passes(floor: Floor, human: Human) -> None:
    """What he has worked on until now counts; of one performance, once."""
    if not human.busy or floor.now <= human.busy_from_s:
        return
    human.last_s[human.busy_task] = min(floor.now, human.busy_until_s)
    if human.asked:
        human.units[human.busy_task], human.asked = human.asked_units, 0
