"""Work that two stations share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.floor.machine import struct

if TYPE_CHECKING:
    from opsim.engine.floor.parts.state import Station


@struct
class Shared:
    """number : among all of them; n_shares : how many these are; n : tasks that are shared

    filled : the share of the partner's buffer from which on the station does them itself
    """

    number: int
    n_shares: int
    station: Station
    partner: Station
    n: int
    filled: float
