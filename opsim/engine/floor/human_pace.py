"""State-dependent pace on the floor: how full the buffers before and behind a worker's station are."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.clock import INF
from opsim.engine.floor.parts.humans import Effects, Model
from opsim.engine.floor.parts.state import Floor, Job, Station, Worker
from opsim.human.state_pace import NEUTRAL_SHARE, Schultz

_shift: Any = inlined(Schultz.shift)
_share: Any = inlined(Schultz.share)


def install(build: Any, effects: Any) -> None:
    """A shift at every worker, where pace depends on the state of the line."""
    if build.plan.human.state_pace is None:
        return
    fed = {
        rank
        for product in build.plan.products
        for ways in product.onward
        for _, then in ways
        if then >= 0
        for rank in product.route[then].stations
    }
    effects.fed = build.ints(rank in fed for rank in range(len(build.stations)))
    build.hang(effects.shifts, shifted)


@step
def shifted(floor: Floor, worker: Worker, station: Station) -> None:
    """By how much his log time shifts now. NOTE: who helps somebody else is asked before he has the job."""
    effects = worker.human.effects
    effects.answer = 0.0
    if worker.job:
        model = effects.state_pace
        effects.answer = _shift(model, _before(effects, model, station), _behind(model, worker.job))


@inlined
def _before(effects: Effects, model: Model, station: Station) -> float:
    """How full the buffer before a station is; all that wait to come in fill it too."""
    if not effects.fed[station.rank]:
        return NEUTRAL_SHARE
    waiting = len(station.queue)
    for i in range(station.n_wanted_by):
        waiting += len(station.wanted_by[i].claims)
    return _share(model, waiting, _room(station))


@inlined
def _behind(model: Model, job: Job) -> float:
    """How full the emptiest of the buffers is that the job may go to next."""
    way = job.plan.steps[job.step].way
    emptiest = INF
    for i in range(way.n):
        if way.to[i] >= 0:
            gate = job.plan.steps[way.to[i]].gate
            for j in range(gate.n_stations):
                filled = _filled(model, gate.stations[j])
                if filled < emptiest:
                    emptiest = filled
    return emptiest if emptiest < INF else NEUTRAL_SHARE


@inlined
def _filled(model: Model, station: Station) -> float:
    room = _room(station)
    if room <= 0:
        return 1.0 if station.n_inside >= station.capacity else 0.0
    return _share(model, max(0, station.n_inside - station.servers), room)


@inlined
def _room(station: Station) -> float:
    """Places of a station that are not on its servers."""
    return INF if station.capacity == INF else station.capacity - station.servers
