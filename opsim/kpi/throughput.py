"""What comes out, how long it stays, how much is inside.

Due dates: how many jobs are late, and by how much.

The rhythm that demand asks for, and how often the floor keeps it.

How evenly work is spread over the line.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.cycle_times import cycle_times
from opsim.kpi.window import (
    SECONDS_PER_HOUR,
    by_rank,
    created_s,
    elapsed_s,
    in_window,
    is_in,
    mean,
    open_hours,
    quantiles,
    units_each,
    window_length_s,
)
from opsim.log import BAD, CREATE, FINISH, LEAVING_KINDS, LOST, EventLog
from opsim.plan import Plan
from opsim.plan.loads import station_loads
from opsim.subjects.material.figures import finishes
from opsim.subjects.release.plan import due_of
from opsim.subjects.shifts.hours import has_hours, scheduled
from opsim.subjects.shifts.plan import Spans, total_s


def throughput(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Good units finished in the window per hour, in all and by product; a lot counts as its units.

    A job that leaves with a defect is not good, though nobody found the defect (``defects_out_share``). What ends in
    a store is no output until it goes out as a part of something. ``throughput_per_h`` counts the hours for which the
    floor is scheduled to be open, ``throughput_per_calendar_h`` all hours of the window; nan where there are none.
    """
    scheduled = open_hours(plan) or np.nan
    done = _ended(log, plan, FINISH)
    product = log["product"][done[log["cause"][done] != BAD]]
    units = np.bincount(product, minlength=len(plan.products)) * units_each(plan)
    calendar = window_length_s(plan) / SECONDS_PER_HOUR
    for name, hours in (("throughput_per_h", scheduled), ("throughput_per_calendar_h", calendar)):
        yield figure(name, "", "", units.sum() / hours)
    finished = [rank for rank in range(len(plan.products)) if finishes(plan, rank)]
    for rank in finished if len(finished) > 1 else ():
        yield figure("throughput_per_h", plan.products[rank].name, "", units[rank] / scheduled)


def lost(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Jobs turned away per hour, and their share of all that arrived in the window at sources that turn jobs away."""
    losing = [rank for rank, source in enumerate(plan.sources) if source.when_full == "lose"]
    if losing:
        n_lost, arrived = _ended(log, plan, LOST).size, _ended(log, plan, CREATE)
        n_arrived = int(np.isin(log["source"][arrived], losing).sum())
        yield figure("lost_per_h", "", "", n_lost / (window_length_s(plan) / SECONDS_PER_HOUR))
        yield figure("lost_share", "", "", n_lost / n_arrived if n_arrived else np.nan)


def times_in_system(log: EventLog, plan: Plan) -> dict[str, np.ndarray]:
    """By product that can finish: seconds from creation to leaving of jobs that finish in the window."""
    done = _ended(log, plan, FINISH)
    stay_s = log["end_s"][done] - created_s(log, log["job"][done])
    parts = by_rank(stay_s, log["product"][done], len(plan.products))
    return {plan.products[rank].name: part for rank, part in enumerate(parts) if finishes(plan, rank)}


def time_in_system(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Time in system, in all: mean and quantiles; and lead time, which is the same of each product.

    Both run from creation to finish: waiting outside a full first buffer belongs to them.
    """
    by_product = times_in_system(log, plan)
    every_s = np.concatenate([*by_product.values(), np.array([])])
    yield figure("time_in_system_s", "", "", mean(every_s))
    for product, stay_s in by_product.items():
        if len(by_product) > 1:
            yield figure("time_in_system_s", product, "", mean(stay_s))
    yield from quantiles("time_in_system_quantile_s", "", every_s)
    for product, stay_s in by_product.items():
        yield figure("lead_time_s", product, "", mean(stay_s))
    for product, stay_s in by_product.items():
        yield from quantiles("lead_time_quantile_s", product, stay_s)


def work_in_progress(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Jobs inside, averaged over the window: in all, and by product where there are several; those in stores too.

    Little's law L = lambda W holds of it exactly where the floor is empty at both ends of the window.
    Source: Little 1961, A proof for the queuing formula L = lambda W, Operations Research 9(3).
    """
    length_s = window_length_s(plan)
    inside_s = _seconds_left(log, plan, CREATE) - _seconds_left(log, plan, *LEAVING_KINDS)
    yield figure("work_in_progress", "", "", inside_s.sum() / length_s)
    for product, spent_s in zip(plan.products, inside_s):
        if len(plan.products) > 1:
            yield figure("work_in_progress", product.name, "", spent_s / length_s)


def _seconds_left(log: EventLog, plan: Plan, *kinds: int) -> np.ndarray:
    """(products,) seconds of the window that follow on the instants of some kinds, summed."""
    low, high = plan.window_s
    rows = np.flatnonzero(np.isin(log["kind"], kinds))
    left_s = high - np.clip(log["end_s"][rows], low, high)
    return np.bincount(log["product"][rows], weights=left_s, minlength=len(plan.products))


def _ended(log: EventLog, plan: Plan, kind: int) -> np.ndarray:
    """Numbers of the rows of a kind that end in the window."""
    rows = np.flatnonzero(log["kind"] == kind)
    return rows[in_window(log["end_s"][rows], plan)]


def due_dates(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Share of jobs that were late, and mean tardiness (early counts as 0), of those that finish in the window and have
    a due date: in all, and by product where there are several.
    """
    if not has_due_dates(plan):
        return
    late_s, product = _lateness_s(log, plan)
    by_product = by_rank(late_s, product, len(plan.products)) if len(plan.products) > 1 else []
    named = [("", late_s), *((made.name, part) for made, part in zip(plan.products, by_product) if part.size)]
    for subject, part_s in named:
        yield figure("late_share", subject, "", mean((part_s > 0).astype(float)))
    for subject, part_s in named:
        yield figure("tardiness_s", subject, "", mean(np.maximum(part_s, 0.0)))


def has_due_dates(plan: Plan) -> bool:
    """Whether some job may have one: of its product, or of its order."""
    by_order = (order.due_s for source in plan.sources for order in source.orders)
    return any(np.isfinite(product.due_s) for product in plan.products) or any(np.isfinite(due_s) for due_s in by_order)


def _lateness_s(log: EventLog, plan: Plan) -> tuple[np.ndarray, np.ndarray]:
    """(jobs,) finish minus due date, and product, of the jobs with a due date that finish in the window."""
    done = np.flatnonzero((log["kind"] == FINISH) & in_window(log["end_s"], plan))
    job, source, product = log["job"][done], log["source"][done], log["product"][done]
    due_s = created_s(log, job) + np.array([made.due_s for made in plan.products])[product]
    for rank, made in enumerate(plan.sources):
        for i in np.flatnonzero(source == rank) if made.orders else ():
            ordered_s = due_of(plan, rank, int(job[i]) // len(plan.sources))
            due_s[i] = ordered_s if np.isfinite(ordered_s) else due_s[i]
    has_one = np.isfinite(due_s)
    return (log["end_s"][done] - due_s)[has_one], product[has_one]


_SLACK = 1 + 1e-9
"""A gap of exactly takt keeps it, whatever the last digit of a sum says."""


def takt(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Takt = open time / demand, and the share of good jobs that follow the one before within takt.

    Demand is what the sources release by time or by order, in the whole run; where only the floor decides (saturated
    sources, a base stock) these figures are absent. Where hours are kept, both count the hours for which the floor is
    scheduled to be open (``opsim.subjects.shifts.hours``): they are what there is to meet the demand in, and a gap
    between two jobs is the open time between them. What leaves outside of these hours, in overtime or after closing,
    follows no rhythm: it is not counted. The job before may have left ahead of the window.
    Source: Rother & Shook 1999, Learning to See, Lean Enterprise Institute (takt time).
    """
    open_s = scheduled(plan) if has_hours(plan) else None
    takt_s = _takt_s(plan, open_s)
    if takt_s is None:
        return
    yield figure("takt_s", "", "", takt_s)
    yield figure("takt_attainment", "", "", mean(_gaps_s(log, plan, open_s) <= takt_s * _SLACK))


def _gaps_s(log: EventLog, plan: Plan, open_s: Spans | None) -> np.ndarray:
    """(n,) seconds from the job before to each that leaves in the window, and in open hours where there are some."""
    finish_s = log["end_s"][log["kind"] == FINISH]
    counted = in_window(finish_s[1:], plan)
    if open_s is None:
        return np.diff(finish_s)[counted]
    return np.diff(elapsed_s(open_s, finish_s))[counted & is_in(open_s, finish_s[1:])]


def _takt_s(plan: Plan, open_s: Spans | None) -> float | None:
    """Open seconds for each job that sources release by themselves; None where they release none."""
    if open_s is None:
        every_s = [found for source in plan.sources if (found := source.job_every_s(plan.horizon_s)) is not None]
        return every_s[0] if len(every_s) == 1 else 1 / sum(1 / one for one in every_s) if every_s else None
    per_s = [found for source in plan.sources if (found := source.jobs_per_s(plan.horizon_s))]
    return (total_s(open_s) / plan.horizon_s / sum(per_s) or np.nan) if per_s else None


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
    yield figure("line_balance_efficiency", "", "", efficiency)
    yield figure("balance_loss", "", "", 1.0 - efficiency)
    yield figure("smoothness_index_s", "", "", np.sqrt((servers * (work_s.max() - work_s) ** 2).sum()))
