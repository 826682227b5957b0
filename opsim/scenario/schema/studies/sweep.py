"""Many points of some factors: what is asked."""

from __future__ import annotations

from opsim.scenario.schema.base import Block


class Sweep(Block):
    """Many points of some factors."""
