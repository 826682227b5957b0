"""The rule that evens out exposure: where a plan has it, the engine counts what each body has gone through so far."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from opsim.plan.plan import Plan

LEAST_EXPOSED = "least_exposed"
"""Its name, among the rules of allocation and among those of rotations."""


def evens_out(plan: Plan) -> bool:
    """Whether any rule of a plan asks who is the least exposed."""
    return LEAST_EXPOSED in (plan.rule, *(rotation.rule for rotation in plan.rotations))
