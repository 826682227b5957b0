"""What a Plan uses of stations: servers, set-ups, sequence, quality, tools, stops, paced lines."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product as pairs
from math import isfinite

from engine_evidence.used_material import reached

from opsim.engine.rules import SEQUENCING_RULES
from opsim.plan import Plan
from opsim.subjects.quality.plan import NOWHERE
from opsim.subjects.stations.plan import STATION, StationPlan

STATION_WORDS = (
    *("station: servers", "station: unlimited buffer", "station: no buffer", "station: buffer_after"),
    *("station: place first", "station: needs", "station: passed", "station: priority"),
    *("hours: finish", "hours: resume", "share: half_full", "share: full"),
    *(f"sequence: {rule}" for rule in SEQUENCING_RULES),
    *("preempt: resume", "preempt: restart", "setup: attended", "setup: alone", "setup: first", "setup: families"),
    *("setup: by a task", "quality: yield", "quality: scrap", "quality: rework", "quality: rework at most"),
    *("quality: false alarms", "quality: spoils", "quality: by worker"),
    *(f"breakdown: {by}, {job}" for by, job in pairs(("clock", "busy", "cycles"), ("resume", "restart", "scrap"))),
    *("breakdown: team", "maintenance: after_job", "maintenance: at_once", "maintenance: team", "repair team: several"),
    *(f"line: {kind}, {then}" for kind, then in pairs(("indexed", "moving"), ("stop", "send_on"))),
    *(f"andon: {kind}, {does}" for kind, does in pairs(("indexed", "moving"), ("take_over", "help"))),
    *("line: drift", "line: upstream", "line: unequal stretches", "line: apart by another length"),
)


def stations_of(plan: Plan) -> set[str]:
    """Its words of ``STATION_WORDS``."""
    here = reached(plan)
    return {*_points(plan, here), *_sequence(plan, here), *_quality(plan, here), *_stops(plan, here), *_lines(plan)}


def _points(plan: Plan, here: set[int]) -> Iterator[str]:
    on_lines = {rank for line in plan.lines for rank in line.stations}
    for rank, station in enumerate(plan.stations):
        if rank in here and station.kind == STATION:
            yield from (f"station: {word}" for word, is_so in _said(station, rank in on_lines).items() if is_so)
            yield from (f"hours: {station.at_close}",) if station.open_s is not None else ()
    for share in plan.shares:
        yield "share: full" if share.filled == 1.0 else "share: half_full"


def _said(station: StationPlan, on_line: bool) -> dict[str, bool]:
    return {
        "servers": station.servers > 1,
        "unlimited buffer": not isfinite(station.buffer) and not on_line,
        "no buffer": station.buffer == 0 and not on_line,
        "buffer_after": station.buffer_after > 0,
        "place first": station.place_first,
        "needs": bool(station.needs),
        "passed": not station.tasks,
        "priority": station.priority != 0,
    }


def _sequence(plan: Plan, here: set[int]) -> Iterator[str]:
    ruled = {queue.station: queue for queue in plan.queues}
    for rank in here:
        if plan.stations[rank].kind == STATION:
            yield f"sequence: {ruled[rank].rule if rank in ruled else 'fifo'}"
    yield from (f"preempt: {one.preempt}" for one in plan.queues if one.preempt and one.station in here)
    for setup in plan.setups:
        changes = [task for row in setup.task for task in row if task >= 0]
        if setup.station in here and changes:
            yield "setup: attended" if setup.attended else "setup: alone"
            yield from ("setup: first",) if setup.first >= 0 else ()
            classes = [number for number in setup.class_of if number >= 0]
            yield from ("setup: families",) if len(set(classes)) < len(classes) else ()
            yield from ("setup: by a task",) if any(":" not in plan.tasks[task].name for task in changes) else ()


def _quality(plan: Plan, here: set[int]) -> Iterator[str]:
    for one in plan.quality:
        back = any(step != NOWHERE for steps in one.back for step in steps)
        said = {
            "yield": one.yield_share < 1 and not one.inspects,
            "spoils": one.yield_share < 1 and one.inspects,
            "scrap": one.inspects and not back and one.yield_share == 1,
            "rework": back,
            "rework at most": back and isfinite(one.most),
            "false alarms": one.false_alarms > 0,
            "by worker": one.by_worker,
        }
        yield from (f"quality: {word}" for word, is_so in said.items() if is_so and one.station in here)


def _stops(plan: Plan, here: set[int]) -> Iterator[str]:
    for stop in plan.breakdowns:
        if stop.station in here:
            yield f"breakdown: {stop.by}, {stop.job}"
            yield from ("breakdown: team",) if stop.team >= 0 else ()
    for care in plan.maintenance:
        if care.station in here:
            yield "maintenance: after_job" if care.after_job else "maintenance: at_once"
            yield from ("maintenance: team",) if care.team >= 0 else ()
    yield from ("repair team: several",) if any(team.n > 1 for team in plan.repair_teams) else ()


def _lines(plan: Plan) -> Iterator[str]:
    for line in plan.lines:
        yield f"line: {line.kind}, {'send_on' if line.sends_on else 'stop'}"
        yield from (f"andon: {line.kind}, {'help' if line.helps else 'take_over'}",) if line.floaters else ()
        ends_m = (*line.start_m[1:], line.exit_s * line.speed_m_per_s)
        limits_m = [limit_s * line.speed_m_per_s for limit_s in line.limit_s]
        yield from ("line: drift",) if any(limit > end + 1e-3 for limit, end in zip(limits_m, ends_m)) else ()
        lengths_m = {round(end - start, 6) for start, end in zip(line.start_m, ends_m)}
        yield from ("line: unequal stretches",) if len(lengths_m) > 1 else ()
        if line.moves and round(line.speed_m_per_s * line.takt_s, 6) not in lengths_m:
            yield "line: apart by another length"
        before = [line.reach_m(at) < line.start_m[at] - 1e-3 for at in range(len(line.reach_s))]
        yield from ("line: upstream",) if any(before) else ()
