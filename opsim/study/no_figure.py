"""Why results have nothing of a figure, and what to do about it."""

from __future__ import annotations

from collections.abc import Iterable

from opsim.kpi.names import KPIS, needs_postures
from opsim.problems import did_you_mean

ONLY_WHERE = {
    "rest_taken_min_per_h": "people rest by need ('human: rest')",
    "fatigue_mean": "people tire ('human: fatigue')",
    "fatigue_most": "people tire ('human: fatigue')",
    "learned_share": "people learn ('human: learning')",
    "experience": "people learn ('human: learning')",
    **dict.fromkeys(("on_duty_h", "duty_use", "overtime_h", "absent_share"), "workers have shifts"),
    **dict.fromkeys(("stops_per_h", "down_s", "wait_for_repair_s", "stop_share"), "stations fail ('stops')"),
}
"""Figures that there are only where the scenario says something; the others are not listed."""


def remedy(kpi: str, names: Iterable[str]) -> str:
    """What is to be said of a figure that is not there: some are made only where the scenario asks for them.

    names : of the figures that there are
    """
    if needs_postures([kpi]):
        return "it is made where the scenario's 'outputs' list it: add it there, and run again"
    if kpi in KPIS:
        why = f": there is one only where {ONLY_WHERE[kpi]}" if kpi in ONLY_WHERE else ""
        return f"these results have none of it{why}"
    return did_you_mean(kpi, names)
