"""Figures as pure functions of an EventLog over the window from warm-up to horizon."""

from importlib import import_module
from typing import Any

_HOMES = {
    "KPIS": "opsim.kpi.catalogue",
    "Figure": "opsim.kpi.catalogue",
    "figures": "opsim.kpi.table",
    "samples": "opsim.kpi.table",
}
__all__ = ["KPIS", "Figure", "figures", "samples"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"opsim.kpi has no {name!r}")
    return getattr(import_module(_HOMES[name]), name)
