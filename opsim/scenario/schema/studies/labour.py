"""What differences between people cost: what is asked."""

from __future__ import annotations

from opsim.scenario.schema.base import Block


class Labour(Block):
    """What differences between people cost."""
