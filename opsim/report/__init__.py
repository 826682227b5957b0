"""What people look at: one offline HTML file a run, and strips of stick figures."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOMES = {
    "bodies_section": "opsim.report.bodies",
    "curves_section": "opsim.report.human_curves",
    "days_section": "opsim.report.days",
    "draw_strips": "opsim.report.strips",
    "scenario_strips": "opsim.report.emulated",
    "walks_section": "opsim.report.walked",
    "write_report": "opsim.report.write",
}
__all__ = [
    "bodies_section",
    "curves_section",
    "days_section",
    "draw_strips",
    "scenario_strips",
    "walks_section",
    "write_report",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"opsim.report has no {name!r}")
    return getattr(import_module(_HOMES[name]), name)
