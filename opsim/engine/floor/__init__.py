"""The floor: its rules in plain Python, driven by SimPy here, and compiled by ``fast_engine``."""

from opsim.engine.floor.run import FloorOfPlan, run_plan

__all__ = ["FloorOfPlan", "run_plan"]
