"""Jobs that wait for a team, and who is chosen. See ``teams``."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, List, struct
from opsim.engine.floor.parts.records import Claim
from opsim.engine.floor.parts.state import Worker


@struct
class Teams:
    """gathering : claims; turn, able, team : those that are gone through just now

    seconds, ks, shifts : of each in a team, how long his part takes, its number, and the shift of his log time
    """

    gathering: List[Claim]
    turn: List[Claim]
    able: List[Worker]
    team: List[Worker]
    seconds: Array[float]
    ks: Array[int]
    shifts: Array[float]
