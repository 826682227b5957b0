"""The fast engine: compiled steps over raw memory. It gives the rows of the reference engine, to the last bit."""

from __future__ import annotations

from collections.abc import Callable

from opsim.engine.fast_engine.machine import complete, needed
from opsim.engine.fast_engine.machine.table import is_complete
from opsim.engine.fast_engine.run import run_plan
from opsim.plan import Plan

__all__ = ["compiled", "ready", "run_plan", "unsupported"]


def unsupported(plan: Plan) -> list[str]:
    """What of a Plan only the reference engine runs, in sentences; nothing where this one runs all of it."""
    from opsim.engine.fast_engine.build import Build
    from opsim.engine.plugin_rules import plugin_rules

    if rules := plugin_rules(plan):
        return list(dict.fromkeys(str(rule) for rule in rules))
    try:
        Build(plan)
    except NotImplementedError as error:
        return [str(error)]
    return []


def compiled(plan: Plan) -> bool:
    """Whether ``ready`` has nothing to compile for a Plan: its machine code is in this process, or on disk."""
    from opsim.engine.fast_engine.build import Build

    return is_complete(needed(Build(plan).steps.values()))


def ready(plan: Plan, told: Callable[[int, int], None] | None = None) -> None:
    """Compile what a Plan needs and is not compiled yet; ``told(done, total)`` says how far it is."""
    from opsim.engine.fast_engine.build import Build

    complete(needed(Build(plan).steps.values()), told)
