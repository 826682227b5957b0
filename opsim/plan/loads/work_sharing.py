"""How evenly work can be shared among people who cannot all do everything, nor all as fast."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import isclose

SMALLEST = 1e-12


def best_share(
    work: Mapping[int, float], seconds: Mapping[int, Mapping[int, float]], time: Sequence[float] | None = None
) -> tuple[float, tuple[int, ...]] | None:
    """The least share of everybody's time in which all work can be done, and the kinds of work that ask for it.

    work : by kind, how many come a second; seconds : by kind, how long one takes whoever can do it; time : of each
    person, by number, 1 where he is always there. None where there is no work.
    """
    kinds = tuple(sorted(kind for kind in work if work[kind] > 0 and seconds[kind]))
    if not kinds:
        return None
    if time is None:
        time = [1.0] * (1 + max(person for kind in kinds for person in seconds[kind]))
    found = _times_and_speeds(kinds, seconds)
    if found is None:
        return _by_programme(kinds, work, seconds, time)
    each_s, speed = found
    wanted = {kind: work[kind] * each_s[kind] for kind in kinds}
    return _by_sets(kinds, wanted, seconds, [share * speed.get(person, 1.0) for person, share in enumerate(time)])


def _times_and_speeds(
    kinds: Sequence[int], seconds: Mapping[int, Mapping[int, float]]
) -> tuple[dict[int, float], dict[int, float]] | None:
    """(seconds of each kind, speed of each person) whose quotients are everybody's times; None where there are none."""
    can: dict[int, list[int]] = {}
    for kind in kinds:
        for person in seconds[kind]:
            can.setdefault(person, []).append(kind)
    each_s: dict[int, float] = {}
    speed: dict[int, float] = {}
    for first in can:
        todo = [] if first in speed else [first]
        speed.setdefault(first, 1.0)
        while todo:
            person = todo.pop()
            for kind in can[person]:
                if kind not in each_s:
                    each_s[kind] = seconds[kind][person] * speed[person]
                    for other in seconds[kind].keys() - speed.keys():
                        speed[other] = each_s[kind] / seconds[kind][other]
                        todo.append(other)
    same = (isclose(each_s[kind], seconds[kind][person] * speed[person]) for kind in kinds for person in seconds[kind])
    return (each_s, speed) if all(same) else None


def _by_programme(
    kinds: Sequence[int], work: Mapping[int, float], seconds: Mapping[int, Mapping[int, float]], time: Sequence[float]
) -> tuple[float, tuple[int, ...]]:
    """The linear programme: least share, such that all work is done and nobody works more than the share of his time.

    The kinds that ask for it are those whose work has a price.
    """
    import numpy as np
    from scipy.optimize import linprog
    from scipy.sparse import csr_array

    pairs = [(row, person, seconds[kind][person]) for row, kind in enumerate(kinds) for person in seconds[kind]]
    people = sorted({person for _, person, _ in pairs})
    row_of = {person: row for row, person in enumerate(people)}
    n, column = len(pairs), np.arange(len(pairs))
    rows, spent = np.array([row_of[person] for _, person, _ in pairs]), np.array([pair[2] for pair in pairs])
    share = -np.array([time[person] for person in people])
    spent_rows, spent_columns = np.r_[rows, np.arange(len(people))], np.r_[column, np.full(len(people), n)]
    within = csr_array((np.r_[spent, share], (spent_rows, spent_columns)), shape=(len(people), n + 1))
    done = csr_array((np.ones(n), (np.array([pair[0] for pair in pairs]), column)), shape=(len(kinds), n + 1))
    wanted = np.array([work[kind] for kind in kinds])
    found = linprog(np.r_[np.zeros(n), 1.0], within, np.zeros(len(people)), done, wanted)
    worth = found.eqlin.marginals * wanted
    return float(found.fun), tuple(kind for kind, part in zip(kinds, worth) if part > 1e-9 * found.fun)


def _by_sets(
    kinds: tuple[int, ...], work: Mapping[int, float], able: Mapping[int, Mapping[int, float]], time: Sequence[float]
) -> tuple[float, tuple[int, ...]]:
    """Where everybody's speed is the same in all he does, without a solver.

    work : by kind, in people. The share is the largest of work(S) / time of people(S) over all sets S of kinds (Hall
    1935); it is found by trying a share, and taking the set that shows it to be too small (Dinkelbach 1967).
    """
    tight, share = kinds, _ratio(kinds, work, able, time)
    while True:
        more = _too_much(share * (1 + 1e-9), kinds, work, able, time)
        if not more or _ratio(more, work, able, time) <= share:
            return share, tight
        tight, share = more, _ratio(more, work, able, time)


def _ratio(
    kinds: Sequence[int], work: Mapping[int, float], able: Mapping[int, Mapping[int, float]], time: Sequence[float]
) -> float:
    people = {person for kind in kinds for person in able[kind]}
    return sum(work[kind] for kind in kinds) / sum(time[person] for person in sorted(people))


def _too_much(
    share: float,
    kinds: Sequence[int],
    work: Mapping[int, float],
    able: Mapping[int, Mapping[int, float]],
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
