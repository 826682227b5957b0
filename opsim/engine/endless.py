"""An instant that would not come to rest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from opsim.plan import Plan

MOST_ROUNDS = 10_000
"""Of dispatching in one instant."""


class EndlessInstant(RuntimeError):
    """An instant that would not come to rest: a loop of zero delays."""


def endless_instant(plan: Plan, floor: Any) -> EndlessInstant:
    """The error, with the names of the stations where something still moves."""
    ranks = {gate.stations[i].rank for gate in floor.stirred for i in range(gate.n_stations)}
    names = ", ".join(sorted(plan.stations[rank].name for rank in ranks))
    where = f"t = {floor.now} s: over {MOST_ROUNDS} rounds in one instant"
    return EndlessInstant(f"{where}; still moving at: {names}")
