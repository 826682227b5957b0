"""Paced lines and crews: people who stop all of it when they are away.

Work that does not fit into the takt of a paced line, with who is called to it.

What the assumption sheet says of paced lines and of crews.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from statistics import harmonic_mean
from typing import TYPE_CHECKING

from opsim.plan.loads.flows import Flows
from opsim.plan.loads.work_times import ANYBODY, WorkTimes
from opsim.plan.plan import Plan
from opsim.problems import Assumption, listed
from opsim.subjects.lines.plan import BUCKET_BRIGADE, LinePlan
from opsim.subjects.people.warnings import on_shifts
from opsim.subjects.shifts.hours import SHORT_S, Hours, lasting, station_names, worker_names
from opsim.subjects.shifts.plan import Spans, at_least, both, total_s, without
from opsim.subjects.tasks.distributions import Fixed

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded


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


def lines(plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of each paced line, most weighty first."""
    for line in plan.lines:
        yield "lines", f"{line.name}: {_late(line)}"
        yield "lines", f"{line.name}: {_moves(line)}"
        if line.floaters:
            names = listed([plan.workers[rank].name for rank in line.floaters])
            how = (
                "takes his own share of what is left, and both are done at once"
                if line.helps
                else "takes a time of his own for what is left, and whoever was there is free"
            )
            yield "lines", f"{line.name}: {names} only when called; who comes {how}"


def _late(line: LinePlan) -> str:
    if line.sends_on:
        return (
            "a job that is not done in time goes on as it is and is bad, whatever is missing; nobody makes up for it "
            "further down, and inspections find it as they find other defects"
        )
    return "while a job that should move on is worked on, the line stands and all other work goes on"


def _moves(line: LinePlan) -> str:
    if not line.moves:
        return "moving on takes no time; while it stands because of a station or a break, its clock stands too"
    return (
        f"jobs come every {line.takt_s:g} s at the earliest, and the line moves {line.speed_m_per_s:.4g} m/s at once "
        "or not at all; workers do not get into each other's way, walk straight to the next job, and whoever comes "
        "from elsewhere is at the beginning of a stretch first"
    )


_HOW_CREWS_SHARE = {
    True: "who comes back takes over the job of the one before him where it is, with a time of his own for what is "
    "left of the task; handing over takes no time",
    False: "everybody goes with his job to the end of the line, and straight back to its start",
}


def crews(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of each crew."""
    for crew in plan.crews:
        names = [plan.workers[worker].name for worker in crew.workers]
        yield "crews", f"{crew.name}: {listed(names)}, in this order; {_HOW_CREWS_SHARE[crew.kind == BUCKET_BRIGADE]}"
        stations = [plan.stations[rank] for rank in crew.stations]
        wide = [station.name for station in stations if station.servers > 1]
        if wide:
            yield "crews", f"{listed(wide)}: side by side somebody may be further in a task, nobody leaves out of turn"
        yield from _others(loaded.scenario.workers, crew.name, names, {station.name for station in stations})


def _others(workers, crew: str, members: list[str], stations: set[str]) -> Iterator[Assumption]:
    """Skills that count for nothing: at the stations of a crew its members work, and they work nowhere else."""
    able = [name for name, worker in workers.items() if name not in members and not stations.isdisjoint(worker.skills)]
    if able:
        yield "crews", f"{listed(able)}: could work at stations of {crew} as well, and never do: no members"
    elsewhere = [name for name in members if set(workers[name].skills) - stations]
    if elsewhere:
        yield "crews", f"{listed(elsewhere)}: could work elsewhere as well, and never do: members of {crew}"
