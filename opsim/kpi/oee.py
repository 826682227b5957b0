"""Overall equipment effectiveness of each station."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import inside_s, window_length_s
from opsim.log import WORK, EventLog
from opsim.plan import Plan


def oee(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """OEE = availability x performance x quality, per server of a station over the window; each factor beside it.

    availability : 1, as no station breaks down and no calendar closes one yet
    performance  : seconds the work done should take by the tasks' mean durations / seconds available. It is speed
                   (should take / took) times use (took / available), so blocking, starving and waiting lower it
    quality      : 1, as nothing is scrapped yet
    Source: Nakajima 1988, Introduction to TPM, Productivity Press (performance = operating speed rate x net operating
    rate; idling and minor stoppages are losses of performance).
    """
    n = len(plan.stations)
    rows = np.flatnonzero((log["kind"] == WORK) & (log["station"] >= 0) & (log["task"] >= 0))
    station, took_s = log["station"][rows], inside_s(log, rows, plan)
    part_inside = took_s / (log["end_s"][rows] - log["start_s"][rows])
    done = (log["progress_to"][rows] - log["progress_from"][rows]) * part_inside
    mean_s = np.array([task.model.mean_duration_s() for task in plan.tasks])[log["task"][rows]]
    planned_s = np.bincount(station, weights=done * mean_s, minlength=n)
    worked_s = np.bincount(station, weights=took_s, minlength=n)
    for rank, place in enumerate(plan.stations):
        available_s = window_length_s(plan) * place.servers
        availability, quality = 1.0, 1.0
        performance = planned_s[rank] / available_s
        yield Figure("oee", place.name, "", "share", availability * performance * quality)
        factors = {"availability": availability, "performance": performance, "quality": quality}
        factors["speed"] = planned_s[rank] / worked_s[rank] if worked_s[rank] > 0 else np.nan
        factors["use"] = worked_s[rank] / available_s
        for part, value in factors.items():
            yield Figure("oee_factor", place.name, part, "share", value)
