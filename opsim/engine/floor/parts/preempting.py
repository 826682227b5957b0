"""Stations where what was begun may be broken off for something more important."""

from __future__ import annotations

from opsim.engine.floor.machine import struct
from opsim.engine.floor.parts.state import Station


@struct
class Preempting:
    """restart : whether what was done of a performance is lost."""

    station: Station
    restart: int
