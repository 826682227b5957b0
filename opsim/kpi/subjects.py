"""Figures that are of one thing each and not of the whole: what has to be named where one of them is asked for."""

from __future__ import annotations

OF_EACH = {
    "worker": (
        *("worker_states", "walked_m", "experience", "trunk_flexion_share", "rest_allowance_share"),
        *("composite_lifting_index", "static_hold_min_per_h", "longest_hold_s", "iso_11226_min_per_h"),
        *("en_1005_4_min_per_h", "movements_per_min", "repetitions_per_min"),
    ),
    "station": (
        *("station_states", "queue_length", "cycle_time_s", "cycle_time_quantile_s", "active_period_s", "oee"),
        *("oee_factor", "stops_per_h", "down_s", "wait_for_repair_s", "mean_time_between_failures_s", "stop_share"),
        *("bottleneck", "exposure_by_station"),
    ),
    "task": ("duration_s", "lifting_index", "lifts_per_h", "exposure_by_task"),
    "product": ("lead_time_s", "lead_time_quantile_s", "exposure_by_product"),
    "store": ("stock", "stock_empty"),
    "conveyor": ("on_conveyor", "conveyor_blocked"),
    "line": ("incomplete_share", "line_stopped_share"),
    "tool": ("tool_use",),
}
"""By what is named: the figures without a figure of the whole."""


def subject_of(kpi: str) -> str:
    """What a figure is of, one each: ``station``; "" where it is of the whole too, or of several kinds of things."""
    return next((kind for kind, names in OF_EACH.items() if kpi in names), "")
