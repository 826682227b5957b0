"""Shares of time of stations: at work, down, or waiting, and for what. The parts of each station sum to 1."""

from collections.abc import Iterator

import numpy as np

from opsim import log as kinds
from opsim.kpi.figure import Figure
from opsim.kpi.lines import possible as why_it_can_stand
from opsim.kpi.open_hours import closed_hours, open_time_s
from opsim.kpi.outages import Stretches, outage_rows, outages_of, stops_of
from opsim.kpi.values import by_rank, changes, inside_s, window_length_s
from opsim.log import BLOCKED, HELD, QUEUE, SETUP, STANDS, WORK, EventLog
from opsim.plan import Plan
from opsim.plan.assembly import jobs_on_a_server
from opsim.plan.hours.spans import Spans, either, without
from opsim.plan.station import STATION

WAITS = {
    "parts": kinds.NO_PARTS,
    "tool": kinds.NO_TOOL,
    "place": kinds.NO_PLACE,
    "pickup": kinds.PICKUP,
    "away": kinds.AWAY,
    "takt": kinds.TAKT,
    "line_stop": kinds.LINE_STOP,
}
"""What a job on a server may wait for, beside a worker: part -> cause."""


def station_states(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each station, per server: work, blocked, waiting (a job wants a worker), starved (no job); where they can be:

    setup : being set up; down, repair : all servers stand, and nobody or somebody repairs or maintains the station
    parts, tool, place, pickup : a job wants parts, tools, a place kept downstream, or a transporter
    away : a job waits for the worker who began it; closed : closed by its calendar, but for what is finished then
    takt, line_stop : on an indexed line, a job is done and waits for the line, which runs or stands
    pause : on a paced line, nobody who works on it is there (breaks, off shift), but for what is finished then
    And the jobs in its buffer or on its servers waiting for something but room, averaged over the window.
    """
    length_s = window_length_s(plan)
    on_floor = np.flatnonzero((log["station"] >= 0) & (log["job"] >= 0) & np.isin(log["kind"], _STATES))
    rows_of = by_rank(on_floor, log["station"][on_floor], len(plan.stations))
    stops = outage_rows(log)
    stations = [(rank, place) for rank, place in enumerate(plan.stations) if place.kind == STATION]
    for rank, place in stations:
        parts = _parts(log, plan, rank, rows_of[rank], stops)
        shares = {part: spent_s / (length_s * place.servers) for part, spent_s in parts.items()}
        for part, share in {**shares, "starved": 1.0 - sum(shares.values())}.items():
            yield Figure("station_states", place.name, part, "share", share)
    for rank, place in stations:
        waits = rows_of[rank]
        waits = waits[np.isin(log["kind"][waits], (QUEUE, HELD))]
        waits = waits[~np.isin(log["cause"][waits], (kinds.AFTER, kinds.PICKUP, kinds.TAKT, kinds.LINE_STOP))]
        yield Figure("queue_length", place.name, "", "jobs", inside_s(log, waits, plan).sum() / length_s)


_STATES = (WORK, SETUP, BLOCKED, HELD, QUEUE)


def _parts(log: EventLog, plan: Plan, rank: int, rows: np.ndarray, stops: np.ndarray) -> dict[str, float]:
    """Seconds of servers in each state but starved. A station that is down is nothing else, whatever stands there; one
    that is closed is at work as long as something is finished there, and else closed, whether it is down or not.
    """
    kind, cause = log["kind"][rows], log["cause"][rows]
    can_be = possible(plan, rank)
    states = {"work": kind == WORK, "blocked": kind == BLOCKED}
    states["waiting"] = (kind == HELD) & (cause != kinds.BATCH)  # the first of a batch stands for all of it
    awaited = [part for part in WAITS if part in can_be]  # the order of a set is another one in every process
    for part in awaited:
        states[part] = states["waiting"] & (cause == WAITS[part])
    for part in awaited:
        states["waiting"] = states["waiting"] & ~states[part]
    if "setup" in can_be:
        states["setup"] = kind == SETUP
    outages = outages_of(log, stops, rank)
    shut = _stretches(closed_hours(plan, rank))
    stands = _stretches(either(_spans(outages), _spans(shut))) if shut.start_s.size else outages
    pauses = _stretches(without(_line_pauses(log, plan, rank), _spans(stands))) if "pause" in can_be else stands
    if "pause" in can_be:
        stands = _stretches(either(_spans(stands), _spans(pauses)))
    start_s, end_s = log["start_s"][rows], log["end_s"][rows]
    parts = {
        part: _up_s(plan, start_s[mask], end_s[mask], outages if part in ("work", "setup") else stands)
        for part, mask in states.items()
    }
    together = jobs_on_a_server(plan, rank)
    if together > 1:
        waits = states["blocked"] | states.pop("pickup", states["blocked"])
        parts["blocked"] = _up_s(plan, *_shared(log, rows[waits], together), stands)
        parts |= {"pickup": 0.0} if "pickup" in parts else {}
    if "down" in can_be:
        for part, number in (("down", kinds.DOWN), ("repair", kinds.REPAIR)):
            here = stops[(log["station"][stops] == rank) & (log["kind"][stops] == number)]
            parts[part] = _up_s(plan, log["start_s"][here], log["end_s"][here], shut) * plan.stations[rank].servers
    busy = np.isin(kind, (WORK, SETUP))
    for part, times, can in (("closed", shut, shut.start_s.size > 0), ("pause", pauses, "pause" in can_be)):
        if can:
            finished_s = times.meet_s(*(np.clip(edge[busy], *plan.window_s) for edge in (start_s, end_s))).sum()
            parts[part] = open_time_s(plan, _spans(times)) * plan.stations[rank].servers - float(finished_s)
    return parts


def _line_pauses(log: EventLog, plan: Plan, rank: int) -> Spans:
    """When nobody was there who works on the line of a station."""
    first = next(line.stations[0] for line in plan.lines if rank in line.stations)
    rows = np.flatnonzero((log["kind"] == STANDS) & (log["station"] == first) & (log["cause"] == kinds.AWAY))
    return tuple(sorted(zip(log["start_s"][rows].tolist(), log["end_s"][rows].tolist())))


def _stretches(spans: Spans) -> Stretches:
    edges_s = np.array(spans, dtype=float).reshape(-1, 2)
    return Stretches(edges_s[:, 0], edges_s[:, 1])


def _spans(stretches: Stretches) -> Spans:
    return tuple(zip(stretches.start_s.tolist(), stretches.end_s.tolist()))


def possible(plan: Plan, rank: int) -> set[str]:
    """The states, beside those of every station, that one can be in."""
    place = plan.stations[rank]
    found = {
        "setup": any(setup.station == rank for setup in plan.setups),
        "down": bool(stops_of(plan, rank)),
        "parts": any(kit.station == rank for kit in plan.kits),
        "tool": bool(place.needs) or any(plan.tasks[task].needs or plan.tasks[task].hold for task in place.tasks),
        "place": place.place_first,
        "pickup": any(leg.before == rank for pool in plan.transporters for leg in pool.legs),
        "away": any(worker.duties is not None and worker.rating[rank] > 0 for worker in plan.workers),
    }
    found |= dict.fromkeys(("takt", "line_stop"), any(rank in line.stations and not line.moves for line in plan.lines))
    found["pause"] = any(rank in line.stations and "away" in why_it_can_stand(plan, line) for line in plan.lines)
    return {part for part, can_be in found.items() if can_be}


def _up_s(plan: Plan, start_s: np.ndarray, end_s: np.ndarray, outages: Stretches) -> float:
    """Seconds of some stretches in the window in which the station was not down."""
    from_s, to_s = np.clip(start_s, *plan.window_s), np.clip(end_s, *plan.window_s)
    return float((to_s - from_s - outages.meet_s(from_s, to_s)).sum())


def _shared(log: EventLog, rows: np.ndarray, together: int) -> tuple[np.ndarray, np.ndarray]:
    """(starts, ends) in seconds for which servers were kept by finished jobs, some of which share one.

    Those that began to wait at one instant share servers, ``together`` of them one, free when the last has left.
    """
    order = rows[np.lexsort([log["start_s"][rows], log["job"][rows]])]
    job, start_s, end_s = (log[column][order] for column in ("job", "start_s", "end_s"))
    first = np.ones(order.size, dtype=bool)
    first[1:] = (job[1:] != job[:-1]) | (start_s[1:] != end_s[:-1])
    last = np.r_[first[1:], True][: order.size]
    start_s, end_s = start_s[first], end_s[last]
    by_start = np.lexsort([-end_s, start_s])
    start_s, end_s = start_s[by_start], end_s[by_start]
    begins = np.flatnonzero(changes(start_s))
    number = np.arange(start_s.size) - np.repeat(begins, np.diff(np.r_[begins, start_s.size]))
    kept = number % together == 0
    return start_s[kept], end_s[kept]
