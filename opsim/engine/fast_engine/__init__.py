"""The fast engine: compiled steps over raw memory. It gives the rows of the reference engine, to the last bit."""

from __future__ import annotations

from opsim.engine.fast_engine import lowering
from opsim.engine.fast_engine.run import compiling_s, is_kept, plug_ins_of, ready, refuse_too_many, run_plan
from opsim.plan import Plan

__all__ = ["compiling_s", "is_kept", "lowering", "ready", "run_plan", "unsupported"]


def unsupported(plan: Plan) -> list[str]:
    """What of a Plan only the reference engine runs, in sentences; nothing where this one runs all of it."""
    from opsim.engine.fast_engine.build import Build

    if said := plug_ins_of(plan):
        return said
    try:
        refuse_too_many(plan)
        Build(plan)
    except NotImplementedError as error:
        return [str(error)]
    return []
