"""Figures sorted by what they are of, so that a long list of them can be read."""

from __future__ import annotations

from opsim.kpi.names import EXPOSURE, POSTURE

FLOW, STATIONS, MATERIAL, PEOPLE, BODIES = "flow", "stations and tasks", "material and transport", "people", "bodies"
KINDS = (FLOW, STATIONS, MATERIAL, PEOPLE, BODIES)
"""In the order in which they are shown."""

_OF = {
    STATIONS: (
        *("station_states", "queue_length", "cycle_time_s", "cycle_time_quantile_s", "duration_s", "oee", "oee_factor"),
        *("active_period_s", "bottleneck", "stops_per_h", "down_s", "wait_for_repair_s", "stop_share"),
        *("mean_time_between_failures_s", "repair_team_use", "tool_use", "tools_waited_for", "line_stopped_share"),
        "incomplete_share",
    ),
    MATERIAL: (
        *("stock", "stock_empty", "stored_per_h", "time_to_store_s", "parts_used_per_h", "on_conveyor"),
        *("conveyor_blocked", "transporter_states", "driven_m", "pickup_wait_s"),
    ),
    PEOPLE: (
        *("worker_states", "walked_m", "on_duty_h", "duty_use", "overtime_h", "absent_share", "interruptions_per_h"),
        *("hand_overs_per_h", "handoff_position", "learned_share", "experience", "fatigue_mean", "fatigue_most"),
        "rest_taken_min_per_h",
    ),
    BODIES: (*POSTURE, *EXPOSURE),
}
_KIND = {kpi: kind for kind, kpis in _OF.items() for kpi in kpis}


def kind_of(kpi: str) -> str:
    """One of KINDS; FLOW for all that is of nothing else."""
    return _KIND.get(kpi, FLOW)
