"""Figures as pure functions of an EventLog over the window from warm-up to horizon."""

from opsim.kpi.figure import Figure
from opsim.kpi.table import KPIS, figures, samples

__all__ = ["KPIS", "Figure", "figures", "samples"]
