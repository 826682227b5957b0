"""Times and names as a sentence says them.

Paced lines and crews: people who stop all of it when they are away.

Work that does not fit into the takt of a paced line, with who is called to it.

Work for which nobody is there: on some shift, at no time, or because people and stations never meet.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from statistics import harmonic_mean

from opsim.plan.calendar import Spans, at_least, both, total_s, without
from opsim.plan.hours import Hours
from opsim.plan.lines import LinePlan
from opsim.plan.loads.flows import Flows
from opsim.plan.loads.work_times import ANYBODY, WorkTimes
from opsim.plan.plan import Plan
from opsim.problems import enumerated, natural_key
from opsim.tasks.distributions import Fixed

SHORT_S = 60.0
"""What is shorter is not worth a word."""


def lasting(seconds: float) -> str:
    """``45 s``, ``30 min``, ``7.5 h``."""
    if seconds < 120:
        return f"{seconds:.3g} s"
    return f"{seconds / 60:.3g} min" if seconds < 5400 else f"{seconds / 3600:.4g} h"


def on_shifts(plan: Plan, hours: Hours, when: Spans) -> str:
    """`` on shift late``, `` on shifts early and late``: those on which people are at some times; empty where none."""
    ranks = [rank for rank in range(len(plan.shifts)) if total_s(both(hours.during(rank), when)) >= SHORT_S]
    names = [plan.shifts[rank].name for rank in ranks]
    return f" on shift{'s' if len(names) > 1 else ''} {enumerated(names)}" if names else ""


def station_names(plan: Plan, ranks: Iterable[int]) -> str:
    """The names of stations, in natural order."""
    return enumerated([plan.stations[rank].name for rank in sorted(ranks)])


def worker_names(plan: Plan, ranks: Iterable[int]) -> str:
    """The names of workers, in natural order."""
    return enumerated([plan.workers[rank].name for rank in sorted(ranks)])


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


def too_long_for_the_takt(plan: Plan, hours: Hours, flows: Flows) -> Iterator[str]:
    """Stations of paced lines whose mean work takes longer than the takt, and people who are called too often for it.

    Work is that of those who can do it; where somebody is called he is taken to come at once.
    """
    times = WorkTimes(plan, hours)
    for line in plan.lines:
        called = [rank for rank in line.stations if _mean_s(times, flows, rank) > line.takt_s]
        for rank in called:
            yield from _too_long(times, flows, line, rank)
        yield from _too_often(times, flows, line, called)


def _too_long(times: WorkTimes, flows: Flows, line: LinePlan, rank: int) -> Iterator[str]:
    alone_s, helped_s = _mean_s(times, flows, rank), _helped_s(times, flows, line, rank)
    if helped_s <= line.takt_s:
        return
    if not line.floaters:
        help_said = ""
    elif helped_s < alone_s:
        help_said = f", and {helped_s:.4g} s with who is called after {lasting(line.call_s)}"
    else:
        help_said = f", and who is called after {lasting(line.call_s)} makes it no shorter"
    each = "every job" if _always(times, flows, line, rank) else "many jobs"
    if line.sends_on:
        so = f"{each} {'goes' if each == 'every job' else 'go'} on unfinished"
    else:
        so = f"the line stands at {each}, for {lasting(helped_s - line.takt_s)} on average"
    yield (
        f"{times.plan.stations[rank].name} does not keep the takt of line {line.name}: its work takes {alone_s:.4g} s "
        f"on average{help_said}, and jobs come every {line.takt_s:.4g} s: {so}"
    )


def _too_often(times: WorkTimes, flows: Flows, line: LinePlan, called: list[int]) -> Iterator[str]:
    """People who could help at each of several stations, and are wanted at all of them at once."""
    wanted = {rank: _helped_s(times, flows, line, rank) for rank in called}
    enough = {rank: helped_s - line.call_s for rank, helped_s in wanted.items() if helped_s <= line.takt_s}
    if sum(enough.values()) > line.takt_s * len(line.floaters):
        who = f"{worker_names(times.plan, line.floaters)} {'is' if len(line.floaters) == 1 else 'are'}"
        yield (
            f"{who} called to every job at {station_names(times.plan, enough)} of line {line.name}, for "
            f"{sum(enough.values()):.4g} s in each takt of {line.takt_s:.4g} s: call later, or give the line "
            "more people"
        )


def _mean_s(times: WorkTimes, flows: Flows, station: int) -> float:
    """Mean time of a job at a station, over the jobs that come, by the mean speed of those who can do it."""
    return _by_people_s(times, flows, station, sorted(times.hours.able(station)) or [ANYBODY])


def _helped_s(times: WorkTimes, flows: Flows, line: LinePlan, station: int) -> float:
    """How long a job takes on average at a station of a line where somebody is called to it in time."""
    alone_s = _mean_s(times, flows, station)
    able = [rank for rank in line.floaters if times.plan.workers[rank].rating[station] > 0]
    if not able or alone_s <= line.call_s:
        return alone_s
    left, other_s = 1 - line.call_s / alone_s, _by_people_s(times, flows, station, able)
    return line.call_s + left * (1 / (1 / alone_s + 1 / other_s) if line.helps else other_s)


def _by_people_s(times: WorkTimes, flows: Flows, station: int, people: Sequence[int]) -> float:
    here = [(flow.product, flow.per_h or flow.per_job) for flow in flows.steps if flow.station == station]
    total = sum(weight for _, weight in here)

    def mean_s(product: int) -> float:
        return harmonic_mean(times.visit_s(worker, station, product) for worker in people)

    return sum(weight / total * mean_s(product) for product, weight in here) if total else 0.0


def _always(times: WorkTimes, flows: Flows, line: LinePlan, station: int) -> bool:
    """Whether every job takes longer than the takt, by whomever it is done."""
    if not all(isinstance(times.plan.tasks[task].model, Fixed) for task in times.plan.stations[station].tasks):
        return False
    products = {flow.product for flow in flows.steps if flow.station == station}
    return all(times.least_visit_s(station, product) > line.takt_s for product in products)


def unmanned(plan: Plan, hours: Hours, by_hand: set[int]) -> Iterator[str]:
    """Stations that nobody on some shift can work at, or nobody ever; people and sources whose hours never come.

    by_hand : ranks of the stations where people have something to do.
    """
    yield from _never_there(plan)
    for station in sorted(by_hand):
        if hours.able(station):
            yield from _station(plan, hours, station)
    yield from _sources(plan, hours, by_hand)


def _never_there(plan: Plan) -> Iterator[str]:
    names = [worker.name for worker in plan.workers if worker.duties is not None and not worker.duties]
    if names:
        who = f"{enumerated(names)} {'is' if len(names) == 1 else 'are'}"
        yield f"{who} never on shift in this run of {lasting(plan.horizon_s)}"


def _station(plan: Plan, hours: Hours, station: int) -> Iterator[str]:
    name, is_open, there = plan.stations[station].name, hours.open(station), hours.manned(station)
    team = hours.team(station)
    if not is_open:
        yield f"{name} is never open in this run of {lasting(plan.horizon_s)}"
    elif not there:
        who = "nobody who can work" if team == 1 else f"never {team} people at once who can work"
        yield f"{who} at {name} {'is ever' if team == 1 else 'are'} on shift: nothing will happen there"
    elif not both(is_open, there):
        who = "nobody is" if team == 1 else f"fewer than {team} people are"
        yield f"{name} is open only when {who} on shift who can work there: nothing will happen there"
    else:
        yield from _sometimes(plan, hours, station, without(both(is_open, hours.somebody), there))


def _sometimes(plan: Plan, hours: Hours, station: int, missing: Spans) -> Iterator[str]:
    """Times at which others work and a station stands for want of its people."""
    if total_s(missing) >= SHORT_S:
        few = "nobody" if hours.team(station) == 1 else "too few people"
        yield (
            f"{few}{on_shifts(plan, hours, missing)} can work at {plan.stations[station].name}: it stands for "
            f"{lasting(total_s(missing))} of the run in which others work "
            f"({total_s(missing) / total_s(hours.open(station)):.0%} of the time that it is open)"
        )


def _sources(plan: Plan, hours: Hours, by_hand: set[int]) -> Iterator[str]:
    """Sources that make jobs only when everybody who would work on them is away."""
    for source in sorted(plan.sources, key=lambda source: natural_key(source.name)):
        made = [plan.products[product] for product, _ in source.mix]
        wanted = {rank for product in made for step in product.route for rank in step.stations} & by_hand
        there = at_least(1, [hours.manned(station) for station in wanted])
        if source.open_s is not None and wanted and there and not both(source.open_s, there):
            yield f"{source.name} lets jobs in only when nobody is there who works on them"
