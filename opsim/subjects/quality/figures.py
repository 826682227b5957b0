"""What is scrapped, reworked, and leaves with a defect that nobody found."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, in_window, units_each, window_length_s
from opsim.log import BAD, FALSE_ALARM, FINISH, REWORK, SCRAP, EventLog
from opsim.plan import Plan


def quality(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Where something can go wrong, in units (a lot is good or bad as a whole), of the window:

    scrap_per_h  : in all, and by the station where it was found
    scrap_share  : of what left the floor, as finished or as scrap
    first_pass_yield : share of what left that was good at the first go: not scrapped, never reworked, without a defect
    defects_out_share : share of what was finished that has a defect
    rework_per_h : in all, and by the station that found it; a job that is reworked twice counts twice
    false_alarm_share : of what was reworked or scrapped after an inspection, the share that was good
    """
    leaves_defects = bool(plan.quality) or any(line.sends_on for line in plan.lines)
    if not leaves_defects and not any(stop.job == "scrap" for stop in plan.breakdowns):
        return
    hours, units = window_length_s(plan) / SECONDS_PER_HOUR, units_each(plan)
    scrapped, finished, reworked = (_rows(log, plan, kind) for kind in (SCRAP, FINISH, REWORK))
    yield from _by_station("scrap_per_h", log, plan, scrapped, hours)
    n_scrapped, n_finished = (units[log["product"][rows]].sum() for rows in (scrapped, finished))
    yield figure("scrap_share", "", "", _ratio(n_scrapped, n_scrapped + n_finished))
    if not leaves_defects:
        return
    good = finished[log["cause"][finished] != BAD]
    at_once = good[~np.isin(log["job"][good], log["job"][log["kind"] == REWORK])]
    n_good, n_at_once = (units[log["product"][rows]].sum() for rows in (good, at_once))
    yield figure("first_pass_yield", "", "", _ratio(n_at_once, n_scrapped + n_finished))
    yield figure("defects_out_share", "", "", _ratio(n_finished - n_good, n_finished))
    if any(plan_of_station.back for plan_of_station in plan.quality):
        yield from _by_station("rework_per_h", log, plan, reworked, hours)
    turned_down = np.r_[scrapped, reworked]
    cause = log["cause"][turned_down]
    n_false, n_bad = (units[log["product"][turned_down[cause == kind]]].sum() for kind in (FALSE_ALARM, BAD))
    if any(plan_of_station.false_alarms for plan_of_station in plan.quality):
        yield figure("false_alarm_share", "", "", _ratio(n_false, n_false + n_bad))


def _rows(log: EventLog, plan: Plan, kind: int) -> np.ndarray:
    """Numbers of the rows of a kind in the window."""
    rows = np.flatnonzero(log["kind"] == kind)
    return rows[in_window(log["end_s"][rows], plan)]


def _by_station(kpi: str, log: EventLog, plan: Plan, rows: np.ndarray, hours: float) -> Iterator[Figure]:
    """Units an hour of some rows, in all and of each station that has some or could."""
    units = units_each(plan)[log["product"][rows]]
    yield figure(kpi, "", "", units.sum() / hours)
    stations = {one.station for one in plan.quality if one.inspects and (one.back or kpi == "scrap_per_h")}
    here = log["station"][rows]
    for rank in sorted(stations | set(here[here >= 0].tolist())):
        yield figure(kpi, plan.stations[rank].name, "", units[here == rank].sum() / hours)


def _ratio(part: float, whole: float) -> float:
    return float(part / whole) if whole else float("nan")
