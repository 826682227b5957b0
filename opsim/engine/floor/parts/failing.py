"""Stations that stop at times, what stops them, and who sees to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.floor.machine import Array, Call, List, struct
from opsim.engine.floor.parts.records import Stream
from opsim.engine.floor.parts.state import Job, Station

if TYPE_CHECKING:
    from opsim.engine.floor.parts.wear import Wear


@struct
class RepairTeam:
    """free : how many stops more it can see to now."""

    free: int
    waiting: List[Stop]


@struct
class Stop:
    """One kind of breakdown or maintenance of a station.

    rank : among all stops; repairs : how long each of its repairs takes; n : how often it has come, less one
    failing : what is known of its station
    kind, since_s : DOWN or REPAIR, and since when, while the station stands because of it

    becomes : of jobs in work, one of RESUMES, RESTARTS, SCRAPPED of ``failing``

    task, cause : in its rows; next_s : of maintenance, until it falls due first, then every_s
    due_line, over_line : steps told when maintenance falls due, and when the repair is over
    """

    rank: int
    station: Station
    team: RepairTeam
    repairs: Stream
    failing: Failing
    n: int
    kind: int
    since_s: float
    task: int
    cause: int
    becomes: int
    after_job: int
    next_s: float
    every_s: float
    due_line: Call
    over_line: Call


@struct
class Failing:
    """closed : whether it is out of its hours

    now : because of which it stands; due : stops that are to come; held : jobs on servers that wait for them

    pending : all stations with stops that are due, by rank; shared by all

    shop : of all such stations; in_work, together : jobs gone through.
    """

    station: Station
    shop: Shop
    wear: Wear
    now: Stop
    due: List[Stop]
    held: List[Job]
    closed: int
    in_work: List[Job]
    together: List[Job]


@struct
class Shop:
    """All stations that fail, by rank, their stops and the teams. pending : stations with stops that are due, by rank

    struck : those of them that are gone through just now
    """

    n_failing: int
    failing: Array[Failing]
    n_stops: int
    stops: Array[Stop]
    n_teams: int
    teams: Array[RepairTeam]
    pending: List[Failing]
    struck: List[Failing]
