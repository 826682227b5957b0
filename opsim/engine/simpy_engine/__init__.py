"""The reference engine: SimPy processes spend the time, one settle step an instant decides."""

from opsim.engine.simpy_engine.run import run_plan

__all__ = ["run_plan"]
