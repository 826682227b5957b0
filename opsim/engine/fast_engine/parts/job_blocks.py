"""What blocks know of a job: beside it, so that jobs of plain floors stay small. A floor with blocks gives each job one."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import struct


@struct
class JobBlocks:
    """The fields of each block stand together, in the order of ``simpy_engine.blocks``."""

    reserved: int
