"""Servers with set-ups."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import struct


@struct
class Servers:
    """takes_line, leaves_line : steps told of a job that takes a server, and of one that leaves it."""

    takes_line: int
    leaves_line: int
