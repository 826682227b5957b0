"""Paced lines: stations whose jobs move together."""

from __future__ import annotations

from typing import Any


def install(build: Any) -> None:
    """A line that moves jobs at intervals, or all the time, for each that the plan has."""
    if not build.plan.lines:
        return
    from opsim.engine.floor.indexed_line import indexed_line
    from opsim.engine.floor.moving_line import moving_line

    build.keep_jobs()
    for plan in build.plan.lines:
        (moving_line if plan.moves else indexed_line)(build, plan)
