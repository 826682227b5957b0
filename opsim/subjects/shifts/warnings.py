"""Breaks that stop the bottleneck: all of its people at once, or all of those who feed it for longer than its buffer
lasts.

Ends of shifts: work that is left under way though others are there, and people whom nobody relieves.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Iterator

from opsim.clock import WEEK_S
from opsim.plan.loads.bottleneck import Loads
from opsim.plan.loads.utilisation import StationLoad, hand_and_alone_s
from opsim.plan.loads.work_times import WorkTimes
from opsim.plan.plan import Plan, TaskPlan
from opsim.subjects.shifts.hours import SHORT_S, Hours, lasting, runs_on_s, station_names, worker_names
from opsim.subjects.shifts.plan import Duty, Spans, both, together, total_s, without

BUSY = 0.8
"""Share of the time of a station from which on a stop of it is output that is lost."""
WORTH = 0.01
"""Share of its hours from which on it is worth a word that it stands."""


def starving_breaks(plan: Plan, hours: Hours, loads: Loads, by_hand: set[int]) -> Iterator[str]:
    """What breaks cost at the station that limits the floor; nothing where it has time to spare."""
    found = _bottleneck(plan, loads)
    if found is None:
        return
    rank, load = found
    if any(rank in line.stations for line in plan.lines):
        return  # a line stands while all its people have a break, and nothing runs dry
    pauses = _pauses(plan, hours, rank) if rank in by_hand else ()
    yield from _all_at_once(plan, hours, loads, rank, pauses)
    for before in sorted(_before(plan, rank) & by_hand):
        yield from _starved(plan, hours, rank, load, before, pauses)


def _all_at_once(plan: Plan, hours: Hours, loads: Loads, rank: int, pauses: Spans) -> Iterator[str]:
    """Breaks of all who can work at the bottleneck; what it does by itself goes on meanwhile."""
    here = [flow for flow in loads.flows.steps if flow.station == rank]
    hand_s, alone_s = hand_and_alone_s(WorkTimes(plan, hours), rank, here)
    if hand_s <= 0:
        return
    on_s = alone_s / (hand_s + alone_s) * sum(runs_on_s(end_s - start_s, alone_s) for start_s, end_s in pauses)
    lost_s = total_s(pauses) - on_s
    if lost_s <= WORTH * total_s(hours.manned(rank)):
        return
    who, at_once = _pausing(hours, rank, pauses)
    remedy = "let them have breaks one after the other, or " if at_once > hours.team(rank) else ""
    yield (
        f"{_said(plan, hours, rank, who, at_once)}: it stands for {lasting(lost_s)} of the run; {remedy}give the skill "
        "to somebody else who is there then"
    )


def _pausing(hours: Hours, station: int, pauses: Spans) -> tuple[list[int], int]:
    """Who of those who can work at a station is on shift in some pauses, and how many at once, at most."""
    there = {worker: both(pauses, hours.on_duty[worker]) for worker in sorted(hours.able(station))}
    who = [worker for worker, spans in there.items() if spans]
    return who, max((len(here) for _, _, here in together([there[worker] for worker in who])), default=0)


def _few(plan: Plan, who: list[int]) -> list[str]:
    names = [plan.workers[worker].name for worker in who]
    return names if len(names) <= 3 else [*names[:2], f"{len(names) - 2} more"]


def _said(plan: Plan, hours: Hours, station: int, who: list[int], at_once: int) -> str:
    """Whose breaks stop the bottleneck."""
    name, names, team = plan.stations[station].name, worker_names(plan, who), hours.team(station)
    if team > 1:
        return f"breaks leave fewer than the {team} people that {name}, the bottleneck, takes ({names})"
    if at_once == 1:
        return f"nobody works at {name}, the bottleneck, in the breaks of {' and of '.join(_few(plan, who))}"
    return f"all who are there and can work at {name}, the bottleneck, have their breaks at once ({names})"


def _bottleneck(plan: Plan, loads: Loads) -> tuple[int, StationLoad] | None:
    """(rank, load) of the station that limits the floor most, if it has no time to spare."""
    ranks = {station.name: rank for rank, station in enumerate(plan.stations)}
    by_name = {load.station: load for load in loads.stations}
    for limit in loads.limits:
        if limit.what in by_name:
            load = by_name[limit.what]
            return None if load.load is not None and load.load < BUSY else (ranks[limit.what], load)
    return None


def _pauses(plan: Plan, hours: Hours, station: int) -> Spans:
    """When a station is open and its people are on shift, and too few of them at work."""
    there = both(hours.open(station), hours.manned(station))
    return without(there, hours.manned(station, at_work=True))


def _before(plan: Plan, station: int) -> set[int]:
    """The stations from which jobs come to a station."""
    found: set[int] = set()
    for product in plan.products:
        for step, ways in zip(product.route, product.onward):
            if any(other >= 0 and station in product.route[other].stations for _, other in ways):
                found.update(step.stations)
    return found - {station}


def _starved(plan: Plan, hours: Hours, rank: int, load: StationLoad, before: int, pauses: Spans) -> Iterator[str]:
    """A station in front whose people all pause for longer than what waits at the bottleneck lasts."""
    n_waiting = plan.stations[rank].buffer + plan.stations[before].buffer_after
    each_s = (load.work_s + load.setup_s) / max(1, load.servers)
    stops = without(_pauses(plan, hours, before), pauses)
    longest_s = max((end_s - start_s for start_s, end_s in stops), default=0.0)
    if longest_s > n_waiting * each_s:
        several = _pausing(hours, before, stops)[1] > hours.team(before)
        remedy = "let them have breaks one after the other, or give it" if several else "give it"
        yield (
            f"{load.station}, the bottleneck, runs dry in the breaks of {plan.stations[before].name}: all who can work "
            f"there pause for {lasting(longest_s)} at once, and the {n_waiting:.0f} jobs that can wait in between last "
            f"{lasting(n_waiting * each_s)}; {remedy} a larger buffer"
        )


RESUME, HAND_OVER = "resume", "hand_over"
LONG = 0.01
"""Share of a shift from which on it is worth a word that somebody works on after its end."""
WEEKS_S = 4 * WEEK_S
"""What is looked at: shifts come again."""


def left_under_way(plan: Plan, hours: Hours, by_hand: Collection[int]) -> Iterator[str]:
    """What the rule at the end of shifts does that is hardly meant, once for each shift."""
    ends = [
        (rank, duty, back_s)
        for rank, worker in enumerate(plan.workers)
        for duty, back_s in _ends(worker.duties or (), plan.horizon_s)
    ]
    for shift in range(len(plan.shifts)):
        mine = [end for end in ends if end[1].shift == shift]
        yield from _held(plan, hours, shift, mine, by_hand)
        yield from _not_relieved(plan, hours, shift, mine, by_hand)


def _ends(duties: tuple[Duty, ...], horizon_s: float) -> Iterator[tuple[Duty, float]]:
    """Shifts after which somebody is away, each with when he is back; the horizon where he is not in this run."""
    for duty, back_s in zip(duties, [*(duty.start_s for duty in duties[1:]), horizon_s]):
        if duty.end_s > WEEKS_S:
            return
        if not duty.cut and back_s - duty.end_s >= SHORT_S:
            yield duty, back_s


def _held(
    plan: Plan, hours: Hours, shift: int, ends: list[tuple[int, Duty, float]], by_hand: Collection[int]
) -> Iterator[str]:
    """Jobs that wait for who began them while others who could go on with them are there; the first time it is so."""
    for worker, duty, back_s in ends:
        others = {
            station: who
            for station in by_hand
            if _leaves_by(plan, hours, shift, station, worker, RESUME)
            and not any(station in crew.stations for crew in plan.crews)
            and (who := _there(plan, hours, station, worker, (duty.end_s, back_s)))
        }
        if others:
            able = worker_names(plan, set().union(*others.values()))
            name = plan.workers[worker].name
            away = f"away for {lasting(back_s - duty.end_s)}" if back_s < plan.horizon_s else "not back in this run"
            yield (
                f"what is under way when shift {plan.shifts[shift].name} ends waits at {station_names(plan, others)} "
                f"for who began it (rule resume), though {able} could go on with it: {name} is {away}; write "
                "hand_over, resume_any or finish"
            )
            return


def _not_relieved(
    plan: Plan, hours: Hours, shift: int, ends: list[tuple[int, Duty, float]], by_hand: Collection[int]
) -> Iterator[str]:
    """Stations where a shift is to hand over long work, and nobody comes before it is done."""
    longest: dict[int, float] = {}
    times = WorkTimes(plan, hours)
    for worker, duty, _ in ends:
        for station in by_hand:
            if _leaves_by(plan, hours, shift, station, worker, HAND_OVER):
                left = _left(plan, shift, station, HAND_OVER)
                seconds = max(times.worker_s(worker, station, task) for task in left)
                alone = not _there(plan, hours, station, worker, (duty.end_s, duty.end_s + seconds))
                if alone and seconds >= LONG * (duty.end_s - duty.start_s):
                    longest[station] = max(seconds, longest.get(station, 0.0))
    if longest:
        yield (
            f"nobody comes to whom shift {plan.shifts[shift].name} could hand over at its end, at "
            f"{station_names(plan, longest)}: who is at work there works on to the end of the task, which takes up to "
            f"{lasting(max(longest.values()))} on average"
        )


def _leaves_by(plan: Plan, hours: Hours, shift: int, station: int, worker: int, rule: str) -> bool:
    return worker in hours.able(station) and bool(_left(plan, shift, station, rule))


def _left(plan: Plan, shift: int, station: int, rule: str) -> list[TaskPlan]:
    """The tasks of a station that one person at a time does, and leaves at the end of a shift by some rule."""
    by_hand = [task for number in plan.stations[station].tasks if not (task := plan.tasks[number]).automatic]
    return [task for task in by_hand if task.team == 1 and (task.interruption or plan.shifts[shift].at_end) == rule]


def _there(plan: Plan, hours: Hours, station: int, worker: int, when: tuple[float, float]) -> set[int]:
    """Who else can work at a station, and is on shift while it is open at some time."""
    spans = [(max(a, when[0]), min(b, when[1])) for a, b in _meeting(hours.open(station), when)]
    others = hours.able(station) - {worker}
    return {other for other in others if any(_long_enough(hours.on_duty[other], span) for span in spans)}


def _meeting(spans: Spans, when: tuple[float, float]) -> Spans:
    """Those that some time meets."""
    first = max(0, bisect_right(spans, (when[0],)) - 1)
    return tuple(span for span in spans[first : bisect_right(spans, (when[1],))] if span[1] > when[0])


def _long_enough(spans: Spans, when: tuple[float, float]) -> bool:
    return any(min(b, when[1]) - max(a, when[0]) >= SHORT_S for a, b in _meeting(spans, when))
