"""The best of several variants, with a promise: what is asked."""

from __future__ import annotations

from opsim.scenario.schema.base import Block


class Select(Block):
    """The best of several variants, with a promise."""
