"""The floor: what its rules share, driven by SimPy here, compiled by ``fast_engine``; the rules are the subjects'."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from opsim.engine.floor.run import FloorOfPlan, run_plan

__all__ = ["FloorOfPlan", "run_plan"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"opsim.engine.floor has no {name!r}")
    from opsim.engine.floor import run

    return getattr(run, name)
