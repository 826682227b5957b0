"""The floor: its rules in plain Python, driven by SimPy here, and compiled by ``fast_engine``."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from opsim.engine.floor.run import FloorOfPlan, run_plan

__all__ = ["FloorOfPlan", "run_plan"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"opsim.engine.floor has no {name!r}")
    from opsim.engine.floor import run

    return getattr(run, name)
