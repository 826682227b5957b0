"""Paced lines and crews: people who stop all of it when they are away."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from opsim.plan.hours import Hours
from opsim.plan.hours.spans import Spans, at_least, both, total_s, without
from opsim.plan.plan import Plan
from opsim.plan.risks.words import SHORT_S, lasting, on_shifts, station_names


def standing_lines(plan: Plan, hours: Hours, by_hand: Collection[int]) -> Iterator[str]:
    """Lines and crews without anybody at one of their stations while others work."""
    for line in plan.lines:
        so = "jobs go on unfinished" if line.sends_on else "the line stands"
        yield from _stands(plan, hours, f"line {line.name}", so, _of(line.stations, by_hand))
    for crew in plan.crews:
        yield from _stands(plan, hours, f"crew {crew.name}", "nothing moves on it", _of(crew.stations, by_hand))


def in_lines(plan: Plan) -> set[int]:
    """The stations of lines and crews."""
    return {rank for line in plan.lines for rank in line.stations} | {r for crew in plan.crews for r in crew.stations}


def _of(stations: Collection[int], by_hand: Collection[int]) -> list[int]:
    return [rank for rank in stations if rank in by_hand]


def _stands(plan: Plan, hours: Hours, what: str, so: str, stations: list[int]) -> Iterator[str]:
    missing = {rank: _missing(plan, hours, rank) for rank in stations}
    empty = [rank for rank in stations if total_s(missing[rank]) >= SHORT_S]
    if empty:
        when = at_least(1, missing.values())
        yield (
            f"nobody{on_shifts(plan, hours, when)} can work at {station_names(plan, empty)} of {what}: {so} for "
            f"{lasting(total_s(when))} of the run in which others work"
        )


def _missing(plan: Plan, hours: Hours, station: int) -> Spans:
    return without(both(hours.open(station), hours.somebody), hours.manned(station))
