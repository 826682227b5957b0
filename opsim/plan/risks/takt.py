"""Work that does not fit into the takt of a paced line, with who is called to it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from opsim.plan.hours import Hours
from opsim.plan.lines import LinePlan
from opsim.plan.loads.rates import Flows
from opsim.plan.loads.work import task_s
from opsim.plan.plan import Plan
from opsim.plan.risks.words import lasting, station_names, worker_names
from opsim.tasks.simple import Fixed


def too_long_for_the_takt(plan: Plan, hours: Hours, flows: Flows) -> Iterator[str]:
    """Stations of paced lines whose mean work takes longer than the takt, and people who are called too often for it.

    Work is that of those who can do it; where somebody is called he is taken to come at once.
    """
    for line in plan.lines:
        called = [rank for rank in line.stations if _mean_s(plan, hours, flows, rank) > line.takt_s]
        for rank in called:
            yield from _too_long(plan, hours, flows, line, rank)
        yield from _too_often(plan, hours, flows, line, called)


def _too_long(plan: Plan, hours: Hours, flows: Flows, line: LinePlan, rank: int) -> Iterator[str]:
    alone_s, helped_s = _mean_s(plan, hours, flows, rank), _helped_s(plan, hours, flows, line, rank)
    if helped_s <= line.takt_s:
        return
    if not line.floaters:
        help_said = ""
    elif helped_s < alone_s:
        help_said = f", and {helped_s:.4g} s with who is called after {lasting(line.call_s)}"
    else:
        help_said = f", and who is called after {lasting(line.call_s)} makes it no shorter"
    each = "every job" if _always(plan, hours, flows, line, rank) else "many jobs"
    if line.sends_on:
        so = f"{each} {'goes' if each == 'every job' else 'go'} on unfinished"
    else:
        so = f"the line stands at {each}, for {lasting(helped_s - line.takt_s)} on average"
    yield (
        f"{plan.stations[rank].name} does not keep the takt of line {line.name}: its work takes {alone_s:.4g} s on "
        f"average{help_said}, and jobs come every {line.takt_s:.4g} s: {so}"
    )


def _too_often(plan: Plan, hours: Hours, flows: Flows, line: LinePlan, called: list[int]) -> Iterator[str]:
    """People who could help at each of several stations, and are wanted at all of them at once."""
    wanted = {rank: _helped_s(plan, hours, flows, line, rank) for rank in called}
    enough = {rank: helped_s - line.call_s for rank, helped_s in wanted.items() if helped_s <= line.takt_s}
    if sum(enough.values()) > line.takt_s * len(line.floaters):
        yield (
            f"{worker_names(plan, line.floaters)} {'is' if len(line.floaters) == 1 else 'are'} called to every job at "
            f"{station_names(plan, enough)} of line {line.name}, for {sum(enough.values()):.4g} s in each takt of "
            f"{line.takt_s:.4g} s: call later, or give the line more people"
        )


def _mean_s(plan: Plan, hours: Hours, flows: Flows, station: int) -> float:
    """Mean time of a job at a station, over the jobs that come, by the mean rating of those who can do it."""
    return _over_jobs_s(plan, flows, station, _mean(_ratings(plan, hours.able(station), station)))


def _helped_s(plan: Plan, hours: Hours, flows: Flows, line: LinePlan, station: int) -> float:
    """How long a job takes on average at a station of a line where somebody is called to it in time."""
    alone_s = _mean_s(plan, hours, flows, station)
    able = [rank for rank in line.floaters if plan.workers[rank].rating[station] > 0]
    if not able or alone_s <= line.call_s:
        return alone_s
    left, other_s = 1 - line.call_s / alone_s, _over_jobs_s(plan, flows, station, _mean(_ratings(plan, able, station)))
    return line.call_s + left * (1 / (1 / alone_s + 1 / other_s) if line.helps else other_s)


def _mean(ratings: list[float]) -> float:
    return sum(ratings) / len(ratings)


def _over_jobs_s(plan: Plan, flows: Flows, station: int, rating: float) -> float:
    here = [(flow.product, flow.per_h or flow.per_job) for flow in flows.steps if flow.station == station]
    total = sum(weight for _, weight in here)
    return sum(weight / total * _work_s(plan, station, product, rating) for product, weight in here) if total else 0.0


def _work_s(plan: Plan, station: int, product: int, rating: float) -> float:
    by_hand = [(task, not plan.tasks[task].automatic) for task in plan.stations[station].tasks]
    return sum(task_s(plan, task, product) / (rating if manual else 1.0) for task, manual in by_hand)


def _always(plan: Plan, hours: Hours, flows: Flows, line: LinePlan, station: int) -> bool:
    """Whether every job takes longer than the takt, by whomever it is done."""
    if not all(isinstance(plan.tasks[task].model, Fixed) for task in plan.stations[station].tasks):
        return False
    ratings = _ratings(plan, [*hours.able(station), *line.floaters], station)
    products = {flow.product for flow in flows.steps if flow.station == station}
    return all(_work_s(plan, station, product, max(ratings)) > line.takt_s for product in products)


def _ratings(plan: Plan, people: Iterable[int], station: int) -> list[float]:
    """Of some people at a station; 1 where nobody is able."""
    return [rating for rank in people if (rating := plan.workers[rank].rating[station]) > 0] or [1.0]
