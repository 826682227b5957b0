"""Figures as a scenario names them: ``throughput_per_h``, ``walked_m/ana``, ``less walked_m/ana``."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator

from opsim.kpi.better import Asked, read_asked
from opsim.kpi.names import KPIS
from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import plain_error


def _known(value: object) -> Asked:
    if not isinstance(value, str):
        raise plain_error(f"expected a figure, found {shown(value)}", "such as throughput_per_h")
    asked = read_asked(value)
    if asked.kpi not in KPIS:
        raise plain_error(f"unknown figure {shown(asked.kpi)}", did_you_mean(asked.kpi, KPIS))
    return asked


def _figure(value: object) -> object:
    _known(value)
    return value


def _with_a_way(value: object) -> object:
    asked = _known(value)
    if not asked.better:
        hint = f"write 'more {asked.name}' or 'less {asked.name}'"
        raise plain_error(f"nothing says whether more or less of {asked.name} is better", hint)
    return value


FigureText = Annotated[str, BeforeValidator(_figure)]
"""A KPI with the subject and the part that are meant, if any, as text; ``read_asked`` takes it apart."""
WayFigureText = Annotated[str, BeforeValidator(_with_a_way)]
"""As FigureText, and which way is better is known: from the KPI, or from ``more`` or ``less`` before it."""
