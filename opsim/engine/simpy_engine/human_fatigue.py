"""Fatigue on the floor: a shift of every log time that a worker draws himself, by how tired he is then."""

from __future__ import annotations

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Station, Worker
from opsim.human.tired import Tired, tired


def install(floor: Floor) -> None:
    """A state at every worker, where people tire."""
    model = floor.plan.human.fatigue
    if model is None:
        return
    burdens = None
    if model.needs_burden:
        from opsim.human.burden import Burdens

        burdens = Burdens(floor.plan, floor.draws.workforce)
    for human in floor.humans:
        human.tired = tired(model, burdens, human.worker.rank)
        human.shifts.append(_Slowed(model, human.tired))


class _Slowed:
    """How far somebody's times are shifted."""

    __slots__ = ("level", "shift", "tired")

    def __init__(self, model, tired: Tired):
        self.shift, self.level, self.tired = model.shift, model.level, tired

    def __call__(self, floor: Floor, _worker: Worker, _station: Station, _task: int, _k: int) -> float:
        tired = self.tired
        if tired.at_s < floor.now:
            tired.pass_to(floor.now)
        return self.shift(self.level(tired.state))
