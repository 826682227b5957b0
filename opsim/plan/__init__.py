"""Scenario -> Plan: names become numbers (in natural order, so number = rank), routes become tables, units are gone.

Both engines read a Plan and nothing else.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from opsim.plan.compile import compile_plan
    from opsim.plan.plan import Plan
    from opsim.plan.ranks import Ranks

_HOMES = {"Plan": "opsim.plan.plan", "Ranks": "opsim.plan.ranks", "compile_plan": "opsim.plan.compile"}
__all__ = ["Plan", "Ranks", "compile_plan"]


def __getattr__(name: str) -> Any:
    # NOTE: subjects hang into the plan, and the plan is made of theirs: imported at once, they would close a circle.
    if name not in _HOMES:
        raise AttributeError(f"opsim.plan has no {name!r}")
    return getattr(import_module(_HOMES[name]), name)
