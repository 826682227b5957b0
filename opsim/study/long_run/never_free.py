"""What a summary says of stations that are never without a job and people who never wait for one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

NEVER = 0.005
"""A state that takes no more of the time than this never occurs, but for the first moments."""


def full_stations(summary: Mapping[str, Any]) -> tuple[str, ...]:
    """Stations that are never without a job."""
    return tuple(name for name, share in _shares(summary, "station_states", "starved") if share <= NEVER)


def nobody_free(summary: Mapping[str, Any]) -> bool:
    """Whether there are people and none of them ever waits for work."""
    waits = [share for _, share in _shares(summary, "worker_states", "wait")]
    return bool(waits) and max(waits) <= NEVER


def _shares(summary: Mapping[str, Any], kpi: str, part: str) -> list[tuple[str, float]]:
    """(station or worker, share of the time) in a state, where it is known."""
    rows = [row for row in summary["kpis"] if (row["kpi"], row["part"]) == (kpi, part)]
    return [(row["subject"], row["mean"]) for row in rows if row["mean"] is not None]
