"""Rules by which jobs are taken out of queues, and by which one of several stations is."""

from __future__ import annotations

from opsim.engine.floor.machine import struct


@struct
class Sequence:
    """rule : its number in ``sequence.SEQUENCING`` or ``ROUTING``; has_ahead : whether mean times are known."""

    rule: int
    has_ahead: int
