"""The part of one worker in a performance of a team."""

from __future__ import annotations

from opsim.engine.floor.machine import struct


@struct
class Stint:
    """See ``stints``."""

    station: int
    product: int
    operation: int
    task: int
    performance_id: int
    k: int
    duration_s: float
    progress_from: float
    pace_shift: float
