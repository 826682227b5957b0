"""Not there yet."""

from __future__ import annotations

from typing import Any


def install(build: Any) -> None:
    """Refuses plans with this block."""
    plan = build.plan
    if plan.rotations:
        raise NotImplementedError("the fast engine does not know: rotations")
