"""How evenly work is spread over the line."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.cycle import cycle_times
from opsim.kpi.figure import Figure
from opsim.kpi.values import mean
from opsim.log import EventLog
from opsim.plan import Plan, station_loads


def line_balance(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Efficiency sum t / (m max t), balance loss 1 - efficiency, smoothness index sqrt(sum (max t - t)^2).

    t is the work that a job brings to a server: the mean work of a visit in the window, times the visits that the
    routes plan for a job, over the servers of the station, each of which counts as one of the m places. Stations on no
    route do not count; nan where a station finished no visit.
    Sources: Salveson 1955, The assembly line balancing problem, J. Industrial Engineering 6(3), 18-25; Moodie & Young
    1965 (smoothness), same journal 16(1), 23-29; Scholl 1999, Balancing and Sequencing of Assembly Lines, Physica.
    """
    by_station = cycle_times(log, plan)
    loads = [load for load in station_loads(plan) if load.visits > 0 and load.station in by_station]
    if not loads:
        return
    on_route = [(load.servers, load.visits, load.station) for load in loads]
    servers = np.array([n for n, _, _ in on_route])
    work_s = np.array([visits * mean(by_station[station]) for _, visits, station in on_route]) / servers
    efficiency = (servers * work_s).sum() / (servers.sum() * work_s.max())
    yield Figure("line_balance_efficiency", "", "", "share", efficiency)
    yield Figure("balance_loss", "", "", "share", 1.0 - efficiency)
    yield Figure("smoothness_index_s", "", "", "s", np.sqrt((servers * (work_s.max() - work_s) ** 2).sum()))
