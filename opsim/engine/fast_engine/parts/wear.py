"""What counts towards the breakdowns of a station: its meter."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import struct


@struct
class Wear:
    """begin_line, end_line, cycle_line : steps told of the begin and end of a performance, and of an operation done."""

    begin_line: int
    end_line: int
    cycle_line: int
