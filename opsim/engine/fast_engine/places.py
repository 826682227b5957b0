"""Not there yet."""

from __future__ import annotations

from typing import Any


def install(build: Any) -> None:
    """Refuses plans with this block."""
    plan = build.plan
    if any(s.place_first or s.buffer_after for s in plan.stations):
        raise NotImplementedError("the fast engine does not know: places")
