"""Names of the figures a scenario may list under ``outputs``; apart, so that reading a scenario needs no numpy."""

KPIS = (
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
