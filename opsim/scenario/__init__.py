"""The scenario language: YAML with units -> checked, frozen scenarios.

``read_scenarios(path)`` gives every variant of a file; a wrong file raises ``ScenarioError`` with all its problems.
Names are loaded when they are used: the schema costs a tenth of a second.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOMES = {
    "Loaded": "opsim.scenario.schema.scenario",
    "read_scenarios": "opsim.scenario.read",
    "Scenario": "opsim.scenario.schema",
    "ScenarioError": "opsim.problems",
    "Problem": "opsim.problems",
}
__all__ = ["Loaded", "Problem", "Scenario", "ScenarioError", "read_scenarios"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"opsim.scenario has no {name!r}")
    return getattr(import_module(_HOMES[name]), name)
