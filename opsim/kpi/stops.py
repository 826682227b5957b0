"""Which breakdown and which maintenance costs a station most, and how busy the repair teams are."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.outages import outage_rows
from opsim.kpi.values import inside_s, window_length_s
from opsim.log import REPAIR, EventLog
from opsim.plan import Plan


def stops(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """stop_share: of each station and each of its stops by name, the share of the window in which it stood for it.

    repair_team_use: of each repair team, the share of its time at stations; 1: at as many as it can see to at once.
    """
    rows = outage_rows(log)
    seconds = inside_s(log, rows, plan)
    stood_s = np.bincount(log["task"][rows], weights=seconds, minlength=len(plan.tasks))
    at_work = log["kind"][rows] == REPAIR
    repaired_s = np.bincount(log["task"][rows][at_work], weights=seconds[at_work], minlength=len(plan.tasks))
    for stop in plan.stops:
        station = plan.stations[stop.station].name
        part = stop.name.removeprefix(f"{station}: ")
        yield Figure("stop_share", station, part, "share", stood_s[stop.task] / window_length_s(plan))
    for rank, team in enumerate(plan.repair_teams):
        spent_s = sum(repaired_s[stop.task] for stop in plan.stops if stop.team == rank)
        yield Figure("repair_team_use", team.name, "", "share", spent_s / (team.n * window_length_s(plan)))
