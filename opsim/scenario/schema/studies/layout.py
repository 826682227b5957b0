"""Which station stands where: what is asked."""

from __future__ import annotations

from opsim.scenario.schema.base import Block


class LayoutStudy(Block):
    """Which station stands where."""
