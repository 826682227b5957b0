"""What the vehicles do right now, and which jobs call for them."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, List, struct
from opsim.engine.floor.parts.state import Job, Station


@struct
class Pickup:
    """A job that waits for a vehicle, its place at the next station sure; calls are ordered as claims are."""

    before: float
    since_s: float
    number: int
    job: Job
    station: Station
    place_from: int


@struct
class Vehicle:
    """number : counted over all transporters; doing : one of FREE to GOING_HOME

    place, came_from : where it is, or drives to, and from where; since_s : since when it does what it does
    answers : the call it is on its way to, or loads; aboard : its jobs, first the one that was loaded first

    rank : where its reports come among those of an instant.
    """

    number: int
    rank: int
    pool: Pool
    place: int
    came_from: int
    doing: int
    since_s: float
    answers: Pickup
    aboard: List[Job]


@struct
class Leg:
    """From a station to another. place_from : where jobs are loaded."""

    pool: Pool
    place_from: int


@struct
class Pool:
    """The vehicles of a transporter. drive_s : by place and place; ready, calls : see ``vehicles``

    turns, idle : vehicles that are gone through just now: those that were ready, and those that are free
    """

    place: int
    capacity: int
    load_s: float
    unload_s: float
    goes_home: int
    drive_s: Array[float]
    n_vehicles: int
    vehicles: Array[Vehicle]
    calls: List[Pickup]
    ready: List[Vehicle]
    n_free: int
    turns: List[Vehicle]
    idle: List[Vehicle]
