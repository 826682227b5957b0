"""What a scenario says of scoring -> Options, with angles in degrees, as the methods' tables have them."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

from opsim.ergonomics.options import Options, Thresholds


def plan_ergonomics(scenario) -> Options:
    """The options of a run."""
    said = scenario.ergonomics
    return Options(
        rate_hz=said.rate_hz,
        arm_reference=said.arm_reference,
        rula_table_a=said.rula.table_a,
        rula_force=said.rula.force,
        owas_disputed=tuple(said.owas.disputed),
        waiting=said.waiting,
        thresholds=_thresholds(said.thresholds),
    )


def _thresholds(said) -> Thresholds:
    names = [field.name for field in fields(Thresholds)]
    return Thresholds(**{name: _value(said, name) for name in names})


def _value(said, name: str) -> Any:
    """Lengths in metres and switches as they are said, angles in degrees."""
    return getattr(said, name) if name in type(said).model_fields else _deg(getattr(said, f"{name}_rad"))


def _deg(angle_rad: float) -> float:
    """NOTE: to a billionth, so that what was written as 10 deg is 10 again."""
    return round(math.degrees(angle_rad), 9)
