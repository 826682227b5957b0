"""What crews know: bucket brigades and rabbit chases."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, List, struct
from opsim.engine.floor.parts.records import Hook
from opsim.engine.floor.parts.state import Gate, Job, Station, Worker


@struct
class Crew:
    """See ``crew``, ``crew_line`` and ``crew_people``, which are one here.

    jobs, carried, gates : of its line; place : by the rank of a station, where in the line it is, -1: elsewhere
    hand, goal, stand : by the number of a member; of ``stand`` -1: he comes from elsewhere
    turn, near : members in the order in which they are asked, and what they are sorted by
    done_here : jobs that are done at a station and wait there; going : those of them that go on just now
    holders : of each job of the line, who has it, or comes for it
    """

    is_brigade: int
    n_stations: int
    stations: Array[Station]
    place: Array[int]
    n_gates: int
    gates: Array[Gate]
    jobs: List[Job]
    carried: List[int]
    carried_now: List[int]
    n_members: int
    members: Array[Worker]
    hand: Array[Job]
    goal: Array[Job]
    stand: Array[int]
    turn: Array[int]
    near: Array[float]
    done_here: List[Job]
    going: List[Job]
    holders: List[int]


@struct
class CrewGate:
    """A gate into the line of a crew. first_place : the first of its stations in the line; picked : what picks else."""

    crew: Crew
    gate: Gate
    first_place: int
    picked: Hook
