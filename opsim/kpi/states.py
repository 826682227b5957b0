"""Shares of time: what workers are doing. The parts of each subject sum to 1.

Shares of time of stations: at work, down, or waiting, and for what. The parts of each station sum to 1.

Active periods: how long a station goes on working without a break.

Which station holds up the floor, moment by moment.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim import log as kinds
from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import by_rank, changes, closed_hours, inside_s, mean, open_time_s, window_length_s
from opsim.log import BLOCKED, BREAK, HELD, QUEUE, SETUP, STANDS, WAIT, WORK, EventLog
from opsim.plan import Plan
from opsim.subjects.breakdowns.figures import Stretches, outage_rows, outages_of, stops_of
from opsim.subjects.lines.figures import possible as why_it_can_stand
from opsim.subjects.material.plan import jobs_on_a_server
from opsim.subjects.shifts.plan import Spans, either, without
from opsim.subjects.stations.plan import STATION

STATE_WORK, STATE_WALK, STATE_IDLE = "work", "walk", "wait"
BY_KIND = {
    **{
        kinds.WORK: STATE_WORK,
        kinds.WALK: STATE_WALK,
        kinds.TRANSPORT: STATE_WALK,
        kinds.WAIT: STATE_IDLE,
        kinds.SETUP: "setup",
    },
    **{kinds.BREAK: "break", kinds.OFF: "off", kinds.ABSENT: "absent"},
}
BY_CAUSE = {
    **{(WAIT, kinds.JOB_BLOCKED): "held", (WAIT, kinds.TEAM): "team", (WAIT, kinds.NO_TOOL): "tool"},
    **{(WAIT, kinds.BEHIND): "behind", (BREAK, kinds.MEETING): "meeting", (BREAK, kinds.REST): "rest"},
}
STATES = tuple(dict.fromkeys([*BY_KIND.values(), *BY_CAUSE.values()]))


def worker_states(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each worker: work, walk, wait (idle), and what else people do here.

    held : standing by a blocked job, where allocation holds him, or he is to carry it; setup : setting a station up;
    team : waiting for the others of a team, before the work or after it; tool : waiting, in the middle of a task, for
    the tool it takes now; behind : waiting for the member of his crew who is ahead of him; rest : by need; break,
    meeting, off, absent : of floors where people work in shifts
    """
    rows, state = states_of_rows(log)
    cell = log["worker"][rows].astype(np.int64) * len(STATES) + state
    n_cells = len(plan.workers) * len(STATES)
    spent_s = np.bincount(cell, weights=inside_s(log, rows, plan), minlength=n_cells).reshape(-1, len(STATES))
    for worker, of_worker in zip(plan.workers, spent_s):
        for part in possible(plan):
            yield figure("worker_states", worker.name, part, of_worker[STATES.index(part)] / window_length_s(plan))


def states_of_rows(log: EventLog) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of the rows that say what a worker does, and (rows,) which of ``STATES`` that is."""
    rows = np.flatnonzero((log["worker"] >= 0) & np.isin(log["kind"], list(BY_KIND)))
    kind, cause = log["kind"][rows], log["cause"][rows]
    of_kind = np.zeros(len(kinds.KINDS), dtype=np.int64)
    for number, state in BY_KIND.items():
        of_kind[number] = STATES.index(state)
    found = of_kind[kind]
    for (number, why), state in BY_CAUSE.items():
        found[(kind == number) & (cause == why)] = STATES.index(state)
    return rows, found


def possible(plan: Plan) -> list[str]:
    """The states that workers of a plan can be in."""
    can_be = {
        "held": plan.when_blocked == "held" or any(product.carried for product in plan.products),
        "setup": any(setup.attended for setup in plan.setups)
        or not all(plan.tasks[task].automatic for _, task in plan.more_setups),
        "team": any(task.team > 1 for task in plan.tasks),
        "tool": any(task.hold is not None for task in plan.tasks),
        "behind": bool(plan.crews),
        "rest": plan.human.rest is not None,
        **dict.fromkeys(("break", "meeting", "off", "absent"), any(w.duties is not None for w in plan.workers)),
    }
    return [STATE_WORK, STATE_WALK, STATE_IDLE, *(part for part, can in can_be.items() if can)]


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
            yield figure("station_states", place.name, part, share)
    for rank, place in stations:
        waits = rows_of[rank]
        waits = waits[np.isin(log["kind"][waits], (QUEUE, HELD))]
        waits = waits[~np.isin(log["cause"][waits], (kinds.AFTER, kinds.PICKUP, kinds.TAKT, kinds.LINE_STOP))]
        yield figure("queue_length", place.name, "", inside_s(log, waits, plan).sum() / length_s)


_STATES = (WORK, SETUP, BLOCKED, HELD, QUEUE)


def _parts(log: EventLog, plan: Plan, rank: int, rows: np.ndarray, stops: np.ndarray) -> dict[str, float]:
    """Seconds of servers in each state but starved. A station that is down is nothing else, whatever stands there; one
    that is closed is at work as long as something is finished there, and else closed, whether it is down or not.
    """
    kind, cause = log["kind"][rows], log["cause"][rows]
    can_be = possible_states(plan, rank)
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


def possible_states(plan: Plan, rank: int) -> set[str]:
    """The states, beside those of every station, that one can be in."""
    place = plan.stations[rank]
    found = {
        "setup": rank in (*(setup.station for setup in plan.setups), *(station for station, _ in plan.more_setups)),
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


@dataclass(frozen=True, slots=True)
class Periods:
    """Active periods of stations, by station and time; every array is (N,). Those of one station do not meet."""

    station: np.ndarray
    start_s: np.ndarray
    end_s: np.ndarray


def active_periods(log: EventLog, plan: Plan) -> Periods:
    """When each station was active: all of its servers at work or set up, or the station down: it could not take more.

    Waiting for a job, for room or for a worker ends a period; the next job at the same instant does not. Periods are
    whole: the window does not cut them, start and horizon of the run do.
    Source: Roser, Nakano & Tanaka 2001, A practical bottleneck detection method, Winter Simulation Conference, 949-953.
    """
    servers = np.array([s.servers for s in plan.stations])
    of_jobs = np.isin(log["kind"], (WORK, SETUP)) & (log["station"] >= 0) & (log["job"] >= 0)
    stops = outage_rows(log)
    rows = np.r_[np.flatnonzero(of_jobs), stops]
    taken = np.ones(rows.size, dtype=int)
    taken[rows.size - stops.size :] = servers[log["station"][stops]]
    station, step = np.tile(log["station"][rows], 2), np.r_[taken, -taken]
    time_s = np.r_[log["start_s"][rows], log["end_s"][rows]]
    order = np.lexsort([time_s, station])
    station, time_s, at_work = station[order], time_s[order], np.cumsum(step[order])
    settled = np.r_[changes(station, time_s)[1:], True][: order.size]
    station, time_s = station[settled], time_s[settled]
    active = at_work[settled] == servers[station]
    before = np.r_[False, active[:-1]][: active.size]
    begins = active & ~before
    return Periods(station[begins], time_s[begins], time_s[before & ~active])


def active_time(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Mean length of the active periods that reach into the window; the longest belongs to the bottleneck."""
    periods = active_periods(log, plan)
    counted = periods.end_s > plan.window_s[0]
    length_s = (periods.end_s - periods.start_s)[counted]
    for station, lengths_s in zip(plan.stations, by_rank(length_s, periods.station[counted], len(plan.stations))):
        if station.tasks:
            yield figure("active_period_s", station.name, "", mean(lengths_s))


def bottleneck(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each station the shares of the window in which it is the bottleneck.

    momentary : its active period is the longest of those under way; with ``none`` (nobody active) these sum to 1
    sole      : it is so, and no period of another station that is the longest at some other moment overlaps
    shifting  : such a period of its own overlaps with one of another station: the bottleneck moves
    Of the whole: shifting (somewhere) and none; with the sole shares these sum to 1.
    Source: Roser, Nakano & Tanaka 2002, Shifting bottleneck detection, Winter Simulation Conference, 1079-1086.
    """
    periods, n = active_periods(log, plan), len(plan.stations)
    edges_s, longest = longest_under_way(periods)
    seconds = np.diff(np.clip(edges_s, *plan.window_s))
    anyone = longest >= 0
    chosen = np.unique(longest[anyone])
    overlapping = _n_under_way(edges_s, periods.start_s[chosen], periods.end_s[chosen])
    alone = overlapping == 1
    momentary_s = np.bincount(periods.station[longest[anyone]], seconds[anyone], n)
    sole_s = np.bincount(periods.station[longest[alone]], seconds[alone], n)
    chosen_s = np.diff(np.clip([periods.start_s[chosen], periods.end_s[chosen]], *plan.window_s), axis=0)[0]
    parts = {"momentary": momentary_s, "sole": sole_s}
    parts["shifting"] = np.maximum(np.bincount(periods.station[chosen], chosen_s, n) - sole_s, 0.0)
    length_s = window_length_s(plan)
    for rank, station in enumerate(plan.stations):
        for part, spent_s in parts.items() if station.tasks else ():
            yield figure("bottleneck", station.name, part, spent_s[rank] / length_s)
    yield figure("bottleneck", "", "shifting", seconds[overlapping > 1].sum() / length_s)
    yield figure("bottleneck", "", "none", 1.0 - seconds[anyone].sum() / length_s)


def longest_under_way(periods: Periods) -> tuple[np.ndarray, np.ndarray]:
    """Edges (M + 1,) in seconds between which nothing begins or ends, and (M,) the longest period there, -1 for none.

    Of equally long ones the station of the smaller rank is taken. Each period is laid over its stretches as two blocks
    of the largest power of two that fits; then blocks are halved, level by level, and the longer one stays on top.
    """
    order = np.lexsort([-periods.station, periods.end_s - periods.start_s])
    edges_s = np.unique(np.r_[periods.start_s, periods.end_s])
    first, last = np.searchsorted(edges_s, periods.start_s[order]), np.searchsorted(edges_s, periods.end_s[order])
    level = np.frexp(last - first)[1] - 1
    top = np.full(max(edges_s.size - 1, 0), -1)
    for power in range(int(level.max(initial=0)), -1, -1):
        block = 2**power
        below = top.copy()
        np.maximum(below[block:], top[:-block], out=below[block:])
        top = below
        here = np.flatnonzero(level == power)
        np.maximum.at(top, first[here], here)
        np.maximum.at(top, last[here] - block, here)
    return edges_s, np.where(top >= 0, np.append(order, -1)[top], -1)


def _n_under_way(edges_s: np.ndarray, start_s: np.ndarray, end_s: np.ndarray) -> np.ndarray:
    """(M,) how many of some periods are under way between each two edges."""
    steps = [np.bincount(np.searchsorted(edges_s, at_s), minlength=edges_s.size) for at_s in (start_s, end_s)]
    return np.cumsum(steps[0] - steps[1])[:-1]
