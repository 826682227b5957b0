"""How evenly work can be shared among people who cannot all do everything."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from itertools import pairwise

SMALLEST = 1e-12


def best_share(
    work: Mapping[int, float], able: Mapping[int, Sequence[int]], time: Sequence[float] | None = None
) -> tuple[float, tuple[int, ...]] | None:
    """The least share of everybody's time in which all work can be done, and the kinds of work that ask for it.

    work : by kind, in people; able : by kind, who can do it; time : of each person, by number, 1 where he is always
    there. The share is the largest of work(S) / time of people(S) over all sets S of kinds (Hall 1935); it is found by
    trying a share, and taking the set that shows it to be too small (Dinkelbach 1967). None where there is no work.
    """
    kinds = tuple(sorted(kind for kind in work if work[kind] > 0 and able[kind]))
    if not kinds:
        return None
    if time is None:
        time = [1.0] * (1 + max(person for kind in kinds for person in able[kind]))
    tight, share = kinds, _ratio(kinds, work, able, time)
    while True:
        more = _too_much(share * (1 + 1e-9), kinds, work, able, time)
        if not more or _ratio(more, work, able, time) <= share:
            return share, tight
        tight, share = more, _ratio(more, work, able, time)


def _ratio(
    kinds: Sequence[int], work: Mapping[int, float], able: Mapping[int, Sequence[int]], time: Sequence[float]
) -> float:
    people = {person for kind in kinds for person in able[kind]}
    return sum(work[kind] for kind in kinds) / sum(time[person] for person in sorted(people))


def _too_much(
    share: float,
    kinds: Sequence[int],
    work: Mapping[int, float],
    able: Mapping[int, Sequence[int]],
    time: Sequence[float],
) -> tuple[int, ...]:
    """Kinds whose work does not fit into a share of the time of all who can do it; empty where everything fits."""
    spare = {person: share * time[person] for kind in kinds for person in able[kind]}
    done: dict[int, dict[int, float]] = {person: {} for person in spare}
    stuck: set[int] = set()
    for kind in kinds:
        left = work[kind]
        while left > SMALLEST:
            way, seen = _way_to_spare(kind, spare, done, able)
            if way is None:
                stuck |= seen
                break
            left -= _hand_on(way, left, spare, done)
    return tuple(sorted(stuck))


def _way_to_spare(kind, spare, done, able) -> tuple[list[tuple[int, int]] | None, set[int]]:
    """[(kind, person), ...]: the person takes the kind, who gives up the next kind of the list, and the last has time.

    Also all kinds that were come by: where there is no way, nobody who can do one of them has any time left.
    """
    came: dict[int, tuple[int, int] | None] = {kind: None}
    person_from: dict[int, int] = {}
    todo = deque([kind])
    while todo:
        here = todo.popleft()
        for person in able[here]:
            if person in person_from:
                continue
            person_from[person] = here
            if spare[person] > SMALLEST:
                return _way(person, person_from, came), set(came)
            for other, share in done[person].items():
                if share > SMALLEST and other not in came:
                    came[other] = (here, person)
                    todo.append(other)
    return None, set(came)


def _way(person: int, person_from: dict[int, int], came) -> list[tuple[int, int]]:
    way = [(person_from[person], person)]
    while (before := came[way[-1][0]]) is not None:
        way.append(before)
    return way[::-1]


def _hand_on(way: list[tuple[int, int]], most: float, spare, done) -> float:
    """Each person of the way takes on as much of his kind as can be handed on to the end; returns how much."""
    amount = min(most, spare[way[-1][1]], *(done[person][other] for (_, person), (other, _) in pairwise(way)))
    for number, (kind, person) in enumerate(way):
        done[person][kind] = done[person].get(kind, 0.0) + amount
        if number + 1 < len(way):
            done[person][way[number + 1][0]] -= amount
    spare[way[-1][1]] -= amount
    return amount
