"""What the vehicles do right now, and which jobs call for them. Data of a run, and the rows of vehicles."""

from __future__ import annotations

from bisect import insort
from dataclasses import dataclass, field
from math import nan
from typing import NamedTuple

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Station, claim_of
from opsim.log import IDLE, NO_CAUSE, PICKUP, TRANSPORT, pack_row
from opsim.plan.transporters import LegPlan, TransporterPlan

FREE, COMING, LOADING, BRINGING, UNLOADING, GOING_HOME = range(6)
_CAUSES = {COMING: PICKUP, GOING_HOME: IDLE}


class Call(NamedTuple):
    """A job that waits for a vehicle, its place at the next station sure; calls are ordered as claims are."""

    before: float
    since_s: float
    number: int
    job: Job
    station: Station
    leg: LegPlan


@dataclass(slots=True, eq=False)
class Vehicle:
    """number : counted over all transporters; doing : one of FREE to GOING_HOME

    place, came_from : where it is, or drives to, and from where; since_s : since when it does what it does
    answers : the call it is on its way to, or loads; aboard : its jobs, first the one that was loaded first
    """

    number: int
    pool: Pool
    place: int
    came_from: int
    doing: int = FREE
    since_s: float = 0.0
    answers: Call | None = None
    aboard: list[Job] = field(default_factory=list)


@dataclass(slots=True, eq=False)
class Pool:
    """The vehicles of a transporter. calls : the first is served first; ready : vehicles that can do their next step

    legs : by (station, station); n_free : vehicles that do nothing
    """

    plan: TransporterPlan
    legs: dict[tuple[int, int], LegPlan]
    vehicles: list[Vehicle] = field(default_factory=list)
    calls: list[Call] = field(default_factory=list)
    ready: list[Vehicle] = field(default_factory=list)
    n_free: int = 0

    def take_call(self, job: Job, station: Station, now: float) -> None:
        """A job calls, to be brought to a station."""
        leg = self.legs[job.station.rank, station.rank]
        insort(self.calls, Call(*claim_of(job, now), station, leg))

    def next_call_at(self, place: int) -> Call | None:
        """The first call from a place, taken out."""
        call = next((call for call in self.calls if call.leg.place_from == place), None)
        if call is not None:
            self.calls.remove(call)
        return call


def now_does(floor: Floor, vehicle: Vehicle, doing: int, place: int) -> None:
    """The vehicle does something else from now on, at a place or on its way to it; what it did is written."""
    log_vehicle(floor, vehicle)
    vehicle.pool.n_free += (doing == FREE) - (vehicle.doing == FREE)
    vehicle.came_from, vehicle.place, vehicle.doing, vehicle.since_s = vehicle.place, place, doing, floor.now


def log_vehicle(floor: Floor, vehicle: Vehicle) -> None:
    """Write what the vehicle did until now, where it was not free: it drove, was loaded or unloaded."""
    if vehicle.doing == FREE or floor.now <= vehicle.since_s:
        return
    floor.write(pack_row(
        TRANSPORT, vehicle.since_s, floor.now, -1, -1, vehicle.came_from, vehicle.place,
        -1, -1, -1, -1, -1, -1, vehicle.number, nan, nan, nan, _CAUSES.get(vehicle.doing, NO_CAUSE),
    ))  # fmt: skip
