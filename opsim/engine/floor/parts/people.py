"""What is known of all people with shifts: who is looked at, who relieves whom, what waits for whom, who is needed."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, Call, List, struct
from opsim.engine.floor.parts.presence import Presence
from opsim.engine.floor.parts.records import Claim
from opsim.engine.floor.parts.state import Job, Worker


@struct
class Relief:
    """Somebody is to take over a job from a worker since a time; taker : who is on his way."""

    leaver: Worker
    job: Job
    since_s: float
    taker: Worker


@struct
class Known:
    """Whether jobs come to stations that are wanted, through those that are passed. comes : by product and step."""

    wanted: Array[int]
    passed: Array[int]
    comes: Array[int]


@struct
class Needs:
    """at_once : by station, how many workers its tasks take at most; 0 where it works alone

    n_open : by station, pairs of times at which it is open, -1: always; open_s : all pairs; first_open : by station
    first_step : by product, where its steps are in ``comes``; n_steps : of all products
    opens : by station, whether it is open before some time; n_able : how many can work there
    mine, lacking, passed : stations as bits, of the question at hand; held : of those inside each, see ``held_up``
    comes : whether jobs come there, by product and step; known : what was found before; last : room for what is not
    """

    at_once: Array[int]
    n_open: Array[int]
    first_open: Array[int]
    open_s: Array[float]
    first_step: Array[int]
    n_steps: int
    opens: Array[int]
    n_able: Array[int]
    mine: Array[int]
    lacking: Array[int]
    passed: Array[int]
    held: Array[int]
    comes: Array[int]
    last: Array[int]
    known: List[Known]


@struct
class People:
    """What ``attendance``, ``leaving``, ``ties`` and ``relief`` know.

    those : the n workers who have shifts, by rank; n_watched : of them; n_tied : jobs that wait for one worker
    left : jobs that somebody would have to carry who has gone off; left_jobs, left_since_s : when they are gone through
    asked, coming : by the rank of who wants to go, and of who is on his way; in_turn : reliefs that are gone through
    pause_over_line and the others : steps that are told; 0 where the floor has nobody who would have to be
    """

    n: int
    those: Array[Presence]
    n_watched: int
    n_tied: int
    left: List[Claim]
    left_jobs: List[Job]
    left_since_s: List[float]
    n_asked: int
    asked: Array[Relief]
    n_coming: int
    coming: Array[Relief]
    in_turn: List[Relief]
    no_relief: Relief
    needs: Needs
    pause_over_line: Call
    turns_back_line: Call
    help_over_line: Call
    disband_line: Call
