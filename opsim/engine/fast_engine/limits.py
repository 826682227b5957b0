"""What the fast engine has numbers for: ranks of 16 bits, in the ids of streams."""

from __future__ import annotations

from opsim.engine.fast_engine.parts.luck import MOST_RANKS
from opsim.plan import Plan

_RANKED = ("workers", "tasks", "stations", "operations", "sources", "stops", "breakdowns")


def refuse_too_many(plan: Plan) -> None:
    """Raises NotImplementedError for a Plan with more of anything than ids can tell apart."""
    for what in _RANKED:
        n = len(getattr(plan, what))
        if n > MOST_RANKS:
            raise NotImplementedError(f"{n:,} {what}, where it tells {MOST_RANKS:,} apart")
