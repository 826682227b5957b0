"""What blocks know of a job: beside it, so that jobs of plain floors stay small. Floors with blocks have them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.floor.machine import Array, Call, List, struct

if TYPE_CHECKING:
    from opsim.engine.floor.parts.doings import Doing
    from opsim.engine.floor.parts.grips import JobTools
    from opsim.engine.floor.parts.ovens import Oven
    from opsim.engine.floor.parts.servers import Stopped
    from opsim.engine.floor.parts.state import Job


@struct
class JobBlocks:
    """The fields of each block stand together.

    taken : pieces that were taken out of it, a lot in a store; given : stations where it had its parts
    next_piece : of what it was split into the first; of a piece, the one behind it
    oven, oven_since_s : in whose queue it waits for a batch, since when; queue_key : by which its place there is found
    server, setups_left, stopped : see ``servers.KNOWN``; 1 + set-ups still to do, 0 where none was asked for; the
            work it was in when it lost its server
    shared : by number of shared work, 1 + how much of it was done at the first station; 0: nobody knows
    worst_at, worst : stations where somebody worked on it, and which share of his work he leaves good there, the least
    tools, doing : what it has, or wants; the performance with a hold under way
    coming, working : of its team, how many are on their way, and how many at work
    on_line, line_began_s, line_open : whether it is on a moving line, what the clock showed when it came onto it,
            and at the how many-th station something is left to be done of it, from 1 on
    line_late, line_ending : whether it is waited for at a limit, or at the end cannot leave
    helped, slower : whether somebody helps with it, and how much longer the rest would take one alone
    """

    reserved: int
    taken: int
    given: List[int]
    next_piece: Job
    oven: Oven
    oven_since_s: float
    queue_key: Array[float]
    server: int
    setups_left: int
    stopped: Stopped
    shared: Array[int]
    worst_at: List[int]
    worst: List[float]
    tools: JobTools
    doing: Doing
    coming: int
    working: int
    on_line: Call
    line_began_s: float
    line_open: int
    line_late: int
    line_ending: int
    helped: int
    slower: float
