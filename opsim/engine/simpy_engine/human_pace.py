"""State-dependent pace on the floor: how full the buffers before and behind a worker's station are."""

from __future__ import annotations

from math import inf

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.human.state_pace import NEUTRAL_SHARE


def install(floor: Floor) -> None:
    """A shift at every worker, where pace depends on the state of the line."""
    model = floor.plan.human.state_pace
    if model is None:
        return
    pace = _StatePace(floor, model)
    for human in floor.humans:
        human.shifts.append(pace)


class _StatePace:
    """Which stations come before and behind which, found once; how full they are, looked up."""

    def __init__(self, floor: Floor, model):
        self.model = model
        self.fed = {
            rank
            for product, steps in zip(floor.plan.products, floor.steps)
            for ways in product.onward
            for _, then in ways
            if then >= 0
            for rank in (station.rank for station in steps[then][2].stations)
        }

    def __call__(self, floor: Floor, worker: Worker, station: Station, _task: int, _k: int) -> float:
        job = worker.job
        if job is None:  # NOTE: who helps somebody else is asked before he has the job
            return 0.0
        return self.model.shift(self.before(station), self.behind(floor, job))

    def before(self, station: Station) -> float:
        """How full the buffer before a station is; all that wait to come in fill it too."""
        if station.rank not in self.fed:
            return NEUTRAL_SHARE
        waiting = len(station.queue) + sum(len(gate.claims) for gate in station.wanted_by)
        return self.model.share(waiting, _room(station))

    def behind(self, floor: Floor, job: Job) -> float:
        """How full the emptiest of the buffers is that the job may go to next."""
        steps = floor.steps[job.product]
        ways = floor.plan.products[job.product].onward[job.step]
        ahead = [station for _, then in ways if then >= 0 for station in steps[then][2].stations]
        return min((self._filled(station) for station in ahead), default=NEUTRAL_SHARE)

    def _filled(self, station: Station) -> float:
        room = _room(station)
        if room <= 0:
            return 1.0 if station.n_inside >= station.capacity else 0.0
        return self.model.share(max(0, station.n_inside - station.plan.servers), room)


def _room(station: Station) -> float:
    """Places of a station that are not on its servers."""
    return inf if station.capacity == inf else station.capacity - station.plan.servers
