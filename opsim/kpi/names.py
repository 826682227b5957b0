"""Names of the figures a scenario may list under ``outputs``; apart, so that reading a scenario needs no numpy."""

from collections.abc import Iterable

USUAL = (
    "throughput_per_h",
    "throughput_per_calendar_h",
    "lost_per_h",
    "lost_share",
    "time_in_system_s",
    "work_in_progress",
    "worker_states",
    "station_states",
    "queue_length",
    "walked_m",
    "cycle_time_s",
    "duration_s",
)
"""What stands in front where a scenario names no outputs."""

WALKING = ("walking_min_per_h", "steps_per_h", "step_length_m", "cadence_per_min", "walking_measured_share")
"""What needs the postures of walking too, of which a scenario's ``walking:`` says where they come from."""

POSTURE = (
    "trunk_beyond_60_min_per_h",
    "trunk_beyond_20_min_per_h",
    "trunk_flexion_mean_deg",
    "trunk_flexion_p95_deg",
    "trunk_flexion_share",
    "posture_measured_share",
    *WALKING,
)
"""What needs the postures behind the work. They are made only where one is asked for, as decoding takes longer than a
run; and how much of the work was measured then stands beside what was asked for."""

SCORED = (
    *("rula_from_5_min_per_h", "rula_from_7_min_per_h", "reba_from_8_min_per_h", "owas_from_3_min_per_h"),
    *("arm_beyond_60_min_per_h", "arm_beyond_90_min_per_h"),
    *("rula_mean", "rula_p90", "rula_most", "reba_mean", "reba_p90", "reba_most"),
    *("posture_dose", "exposure_gini"),
    *("exposure_by_station", "exposure_by_task", "exposure_by_product", "exposure_by_hour"),
)
REGION = ("exposure_by_region",)
LIFTED = ("lifting_index", "composite_lifting_index", "lifts_per_h", "lifts_out_of_range_share")
HELD = (
    *("static_hold_min_per_h", "longest_hold_s", "iso_11226_min_per_h", "en_1005_4_min_per_h", "movements_per_min"),
    "repetitions_per_min",
)
ENERGY, REST = ("energy_kcal_per_min",), ("rest_allowance_share",)
EXPOSURE = (*SCORED, *REGION, *LIFTED, *HELD, *ENERGY, *REST)
"""What bodies went through in the whole shift: one pass over all postures, made only where one of these is asked."""

TRIPS = ("trips_per_h",)
"""Of every pair of places: made only where asked for, as there may be thousands of pairs."""

KPIS = (
    *USUAL,
    "time_in_system_quantile_s",
    "lead_time_s",
    "lead_time_quantile_s",
    "cycle_time_quantile_s",
    "late_share",
    "tardiness_s",
    "takt_s",
    "takt_attainment",
    "line_balance_efficiency",
    "balance_loss",
    "smoothness_index_s",
    "oee",
    "oee_factor",
    "active_period_s",
    "bottleneck",
    "stops_per_h",
    "down_s",
    "wait_for_repair_s",
    "mean_time_between_failures_s",
    "stop_share",
    "repair_team_use",
    "stock",
    "stock_empty",
    "stored_per_h",
    "time_to_store_s",
    "parts_used_per_h",
    "on_conveyor",
    "conveyor_blocked",
    "transporter_states",
    "driven_m",
    "pickup_wait_s",
    "scrap_per_h",
    "scrap_share",
    "first_pass_yield",
    "defects_out_share",
    "rework_per_h",
    "false_alarm_share",
    "tool_use",
    "tools_waited_for",
    "on_duty_h",
    "duty_use",
    "overtime_h",
    "absent_share",
    "interruptions_per_h",
    "hand_overs_per_h",
    "handoff_position",
    "incomplete_share",
    "line_stopped_share",
    "learned_share",
    "experience",
    "fatigue_mean",
    "fatigue_most",
    "rest_taken_min_per_h",
    *TRIPS,
    *POSTURE,
    *EXPOSURE,
)


def needs_postures(asked: Iterable[str]) -> bool:
    """Whether any of some figures is one of ``POSTURE`` or ``EXPOSURE``."""
    return not {*POSTURE, *EXPOSURE}.isdisjoint(asked)


def headline(outputs: Iterable[str]) -> set[str]:
    """What stands in front where these outputs are asked for."""
    asked = set(outputs)
    beside = {"walking_measured_share"} if asked.intersection(WALKING) else set()
    return asked | beside | {"posture_measured_share"} if needs_postures(asked) else asked
