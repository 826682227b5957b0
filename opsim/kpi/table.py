"""All figures of a replication, and the samples behind the histograms."""

import numpy as np

from opsim.kpi.cycle import cycle_times, mean_cycle_times, mean_durations, task_durations
from opsim.kpi.figure import Figure
from opsim.kpi.flow import lost, throughput, time_in_system, times_in_system, work_in_progress
from opsim.kpi.states import queue_lengths, station_states, worker_states
from opsim.kpi.walking import walked
from opsim.log import EventLog
from opsim.plan import Plan

_FUNCTIONS = (
    throughput,
    lost,
    time_in_system,
    work_in_progress,
    worker_states,
    station_states,
    queue_lengths,
    walked,
    mean_cycle_times,
    mean_durations,
)


def figures(log: EventLog, plan: Plan) -> list[Figure]:
    """Every figure this log has, in one fixed order."""
    return [figure._replace(value=float(figure.value)) for function in _FUNCTIONS for figure in function(log, plan)]


def samples(log: EventLog, plan: Plan) -> dict[tuple[str, str], np.ndarray]:
    """(kpi, subject) -> the single values in the window behind the means."""
    named = {
        "time_in_system_s": times_in_system,
        "cycle_time_s": cycle_times,
        "duration_s": task_durations,
    }
    return {
        (kpi, subject): values for kpi, function in named.items() for subject, values in function(log, plan).items()
    }
