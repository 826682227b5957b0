"""Work for which nobody is there: on some shift, at no time, or because people and stations never meet.

Rotations that leave a station empty: too few people for the posts, or nobody at a post who can do the work.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import NamedTuple

from opsim.plan.plan import Plan
from opsim.problems import enumerated, natural_key
from opsim.subjects.people.plan import RotationPlan
from opsim.subjects.shifts.hours import SHORT_S, Hours, lasting, station_names, worker_names
from opsim.subjects.shifts.plan import Spans, at_least, both, together, total_s, without


def on_shifts(plan: Plan, hours: Hours, when: Spans) -> str:
    """`` on shift late``, `` on shifts early and late``: those on which people are at some times; empty where none."""
    ranks = [rank for rank in range(len(plan.shifts)) if total_s(both(hours.during(rank), when)) >= SHORT_S]
    names = [plan.shifts[rank].name for rank in ranks]
    return f" on shift{'s' if len(names) > 1 else ''} {enumerated(names)}" if names else ""


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


class There(NamedTuple):
    """Who is on shift at once: members by their numbers in the list, and others by rank."""

    members: tuple[int, ...]
    others: frozenset[int]


def empty_posts(plan: Plan, hours: Hours, by_hand: set[int]) -> Iterator[str]:
    """For each rotation the stations at which too few people may work in some of its turns, at its worst hour."""
    for rotation in plan.rotations:
        stations = {rank for post in rotation.posts for rank in post} & by_hand
        found = [(there, _empty(plan, hours, rotation, there, stations)) for there in _who_are_there(hours, rotation)]
        there, empty = max(found, key=lambda pair: (sum(pair[1].values()), len(pair[0].members)), default=(None, {}))
        if there is not None and empty:
            n_turns = _turns(rotation, there)
            few = ""
            if len(there.members) < len(rotation.workers):
                names = worker_names(plan, [rotation.workers[member] for member in there.members])
                few = f" while of its members {names} {'is' if len(there.members) == 1 else 'are'} on shift alone"
            yield (
                f"rotation {rotation.name} leaves {station_names(plan, empty)} empty in {max(empty.values())} of its "
                f"{n_turns} turns{few} ({len(there.members)} people for {len(rotation.posts)} posts)"
            )


def _who_are_there(hours: Hours, rotation: RotationPlan) -> list[There]:
    """Who are on shift together, for at least some time of the run in all."""
    stations = {rank for post in rotation.posts for rank in post}
    ranks = sorted({*rotation.workers, *(worker for station in stations for worker in hours.able(station))})
    lasts_s: defaultdict[There, float] = defaultdict(float)
    for start_s, end_s, numbers in together(hours.on_duty[rank] for rank in ranks):
        there = {ranks[number] for number in numbers}
        members = tuple(n for n, worker in enumerate(rotation.workers) if worker in there)
        lasts_s[There(members, frozenset(there - {*rotation.workers}))] += end_s - start_s
    return [there for there, seconds in lasts_s.items() if there.members and seconds >= SHORT_S]


def _empty(plan: Plan, hours: Hours, rotation: RotationPlan, there: There, stations: set[int]) -> Counter[int]:
    """{station: in how many turns too few may work there}."""
    can, everywhere, empty = rotation.can(plan.workers), (1 << len(plan.stations)) - 1, Counter[int]()
    for turn in range(_turns(rotation, there)):
        at = rotation.by_turns(there.members, turn, can)
        for station in stations:
            able = hours.able(station)
            mine = sum(
                1
                for member, post in at.items()
                if rotation.workers[member] in able and rotation.leaves(post, everywhere) >> station & 1
            )
            if mine + len(able & there.others) < hours.team(station):
                empty[station] += 1
    return empty


def _turns(rotation: RotationPlan, there: There) -> int:
    """After so many changes everybody is where he was."""
    return max(len(there.members), len(rotation.posts))
