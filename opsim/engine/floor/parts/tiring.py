"""Fatigue of a worker: told when he works and when he is broken off, he rests between. See ``opsim.human.tired``."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined
from opsim.engine.floor.parts.humans import Human
from opsim.engine.floor.parts.state import Floor


@inlined
def pass_to_now(floor: Floor, human: Human) -> None:
    """Time goes on for his fatigue until now."""
    if human.at_s < floor.now:
        human.effects.pass_line(floor, human)


@inlined
def level(floor: Floor, human: Human) -> float:
    """How tired he is, 0 (fresh, or where nobody tires) to 1."""
    if not human.effects.pass_line:
        return 0.0
    pass_to_now(floor, human)
    return human.tired


@inlined
def tires(floor: Floor, human: Human, task: int, until_s: float, done: float) -> None:
    """He works on a task from now, at a share of it, until it is done then."""
    pass_to_now(floor, human)
    human.task, human.begun_s, human.until_s, human.done = task, floor.now, until_s, done


@inlined
def stops_tiring(floor: Floor, human: Human) -> None:
    """He works no more."""
    pass_to_now(floor, human)
    human.task = -1


@inlined
def note_that_he_works(floor: Floor, human: Human) -> None:
    """Nobody else can have become too tired. Those who have worked are in the order of their ranks."""
    if human.has_worked:
        return
    human.has_worked = 1
    worked, rank = human.effects.worked, human.worker.rank
    at = len(worked)
    while at > 0 and worked[at - 1].rank > rank:
        at -= 1
    worked.insert(at, human.worker)
