"""What the fast engine does not run: rules that are plug-ins in Python, and more than there are ids of streams for."""

from __future__ import annotations

from opsim.engine.fast_engine.parts.luck import MOST_RANKS
from opsim.engine.plugin_rules import plugin_rules
from opsim.plan import Plan

_RANKED = ("workers", "tasks", "stations", "operations", "sources", "stops", "breakdowns")


def refuse_too_many(plan: Plan) -> None:
    """Raises NotImplementedError for a Plan with more of anything than ids can tell apart."""
    for what in _RANKED:
        n = len(getattr(plan, what))
        if n > MOST_RANKS:
            raise NotImplementedError(f"{n:,} {what}, where it tells {MOST_RANKS:,} apart")


def plug_ins_of(plan: Plan) -> list[str]:
    """Rules that only Python can follow, in words, each once."""
    return list(dict.fromkeys(map(str, plugin_rules(plan))))


def refuse_plug_ins(plan: Plan) -> None:
    """Raises NotImplementedError for a Plan with rules that only Python can follow."""
    if said := plug_ins_of(plan):
        raise NotImplementedError("; ".join(said))
