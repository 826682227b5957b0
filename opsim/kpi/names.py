"""Names of the figures a scenario may list under ``outputs``; apart, so that reading a scenario needs no numpy."""

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

KPIS = (
    *USUAL,
    "time_in_system_quantile_s",
    "lead_time_s",
    "lead_time_quantile_s",
    "cycle_time_quantile_s",
    "takt_s",
    "takt_attainment",
    "line_balance_efficiency",
    "balance_loss",
    "smoothness_index_s",
    "oee",
    "oee_factor",
    "active_period_s",
    "bottleneck",
)
