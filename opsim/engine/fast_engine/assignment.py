"""Not there yet."""

from __future__ import annotations

from typing import Any


def install(build: Any) -> None:
    """Refuses plans with this block."""
    plan = build.plan
    if plan.rule == 'least_exposed' or plan.rule == 'most_downstream' or plan.priorities or any(w.zone or w.floater for w in plan.workers) or (plan.idle == 'patrol' and plan.serve == 'one'):
        raise NotImplementedError("the fast engine does not know: assignment")
