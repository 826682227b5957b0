"""Rotations that leave a station empty: too few people for the posts, or nobody at a post who can do the work."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import NamedTuple

from opsim.plan.hours import Hours
from opsim.plan.hours.spans import together
from opsim.plan.plan import Plan
from opsim.plan.risks.words import SHORT_S, station_names, worker_names
from opsim.plan.rotations import RotationPlan


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
