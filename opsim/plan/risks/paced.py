"""Paced lines and crews: work that does not fit into the takt; people who stop all of it when they are away."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from opsim.plan.hours import Hours
from opsim.plan.hours.spans import Spans, at_least, both, total_s, without
from opsim.plan.loads.rates import Flows
from opsim.plan.loads.work import task_s
from opsim.plan.plan import Plan
from opsim.plan.risks.words import SHORT_S, lasting, on_shifts, station_names


def too_long_for_the_takt(plan: Plan, hours: Hours, flows: Flows) -> Iterator[str]:
    """Stations of paced lines whose mean work, by those who can do it, takes longer than the takt."""
    for line in plan.lines:
        for rank in line.stations:
            mean_s = _mean_s(plan, hours, flows, rank)
            if mean_s > line.takt_s:
                so = "most jobs go on unfinished" if line.sends_on else "the line stands at every other job"
                yield (
                    f"{plan.stations[rank].name} does not keep the takt of line {line.name}: its work takes "
                    f"{mean_s:.4g} s on average, and jobs come every {line.takt_s:.4g} s: {so}"
                )


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


def _mean_s(plan: Plan, hours: Hours, flows: Flows, station: int) -> float:
    """Mean time of a job at a station, over the jobs that come, by the mean rating of those who can do it."""
    ratings = [plan.workers[worker].rating[station] for worker in hours.able(station)]
    rating = sum(ratings) / len(ratings) if ratings else 1.0
    here = [(flow.product, flow.per_h or flow.per_job) for flow in flows.steps if flow.station == station]
    total = sum(weight for _, weight in here)
    return sum(weight / total * _work_s(plan, station, product, rating) for product, weight in here) if total else 0.0


def _work_s(plan: Plan, station: int, product: int, rating: float) -> float:
    by_hand = [(task, not plan.tasks[task].automatic) for task in plan.stations[station].tasks]
    return sum(task_s(plan, task, product) / (rating if manual else 1.0) for task, manual in by_hand)
