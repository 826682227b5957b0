"""Times behind which no movement stands."""

from __future__ import annotations

from opsim.report.material import Material
from opsim.report.section import Grid, Section, Words
from opsim.report.words import quantity

SAID = "No movement stands behind these times. They are what the scenario says, and nobody measured them here."


def section(material: Material) -> Section | None:
    """Every task that is not emulated, with its model of time."""
    tasks = [task for task in material.summary.get("tasks", []) if not task.get("emulated")]
    rows = [
        (task["task"], task["station"], task["model"], quantity(task["mean_s"], "s"), _tag(task["model"]))
        for task in tasks
    ]
    columns = ("Task", "Station", "Time model", "Mean", "From")
    table = Grid(columns, rows, "", words=3, left=(4,), tags=(4,), said="times without recordings")
    return Section("made-up", "Times without recordings", [Words(SAID), table], "Assumed times") if rows else None


def _tag(model: str) -> str:
    return "times from a file" if model.startswith("recorded") else "made up"
