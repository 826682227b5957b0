"""The blocks of the station model: what each hangs on a floor before a run."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

NAMES = (
    *("assignment", "stores", "kits", "splits", "batches", "setup", "sequence", "places", "cards", "base_stock"),
    *("quality", "work_sharing", "hands", "failures", "preemption", "opening", "conveyors", "transporters", "lines"),
    *("duty", "crews", "rotations", "humans", "doses"),
)
"""Files of this folder with an ``install(build)``, in the order in which they hang in."""


def install_all(build: Any) -> None:
    """Each looks at its own part of the plan, and does nothing where that is empty."""
    for name in NAMES:
        install: Callable[[Any], None] = import_module(f"opsim.engine.floor.{name}").install
        install(build)
