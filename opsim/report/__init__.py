"""What people look at: one offline HTML file a run, and strips of stick figures."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOMES = {
    "Material": "opsim.report.material",
    "draw_strips": "opsim.report.sections.motions",
    "materials": "opsim.report.material",
    "report_html": "opsim.report.render",
    "write_report": "opsim.report.render",
}
__all__ = ["Material", "draw_strips", "materials", "report_html", "write_report"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"opsim.report has no {name!r}")
    return getattr(import_module(_HOMES[name]), name)
