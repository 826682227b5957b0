"""Discrete-event simulation of production whose work is done by people.

The table of contents; each name is loaded when it is first used (PEP 562), so that importing opsim costs nothing.
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_HOMES = {
    "EventLog": "opsim.log",
    "Floor": "opsim.floor",
    "Performance": "opsim.performance",
    "Performances": "opsim.task_model",
    "Plan": "opsim.plan",
    "Result": "opsim.results",
    "Scenario": "opsim.scenario",
    "ScenarioError": "opsim.scenario",
    "TaskModel": "opsim.task_model",
    "Worker": "opsim.external_worker",
    "WorkerLog": "opsim.external_log",
    "audit": "opsim.laws.audit",
    "compile_plan": "opsim.plan",
    "exposure_of": "opsim.kpi.external_workers",
    "figures": "opsim.kpi",
    "read_events": "opsim.log_parquet",
    "read_scenarios": "opsim.scenario",
    "run_plan": "opsim.engine.floor.run",
    "run_scenario": "opsim.study",
    "stream": "opsim.streams",
    "t_interval": "opsim.study",
    "write_events": "opsim.log_parquet",
}
__all__ = ["__version__", *_HOMES]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"opsim has no {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
