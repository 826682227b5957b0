"""Stations where what was begun may be broken off for something more important."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import struct
from opsim.engine.fast_engine.parts.state import Station


@struct
class Preempting:
    """restart : whether what was done of a performance is lost."""

    station: Station
    restart: int
