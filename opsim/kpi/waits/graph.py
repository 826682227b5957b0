"""Who waits for what, and who has it: what can still move, and the circles of those who cannot."""

from collections import deque
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

from opsim.graph import rings

Way = tuple[tuple[str, int], ...]
"""(pool, units) of all that is wanted together."""


@dataclass(slots=True)
class Pool:
    """Something that is had and given back: places, cards, tools, workers, or pieces that somebody still brings.

    what    : in words, such as ``a place at paint``
    free    : units that nobody has
    holders : name -> units he has and gives back once he can move on
    """

    what: str
    free: float = 0
    holders: dict[str, int] = field(default_factory=dict)

    def give_to(self, holder: str, units: int = 1) -> None:
        self.holders[holder] = self.holders.get(holder, 0) + units


def stuck(waits: Mapping[str, Collection[Way]], pools: Mapping[str, Pool]) -> set[str]:
    """Those who can never move again: the largest set in which everybody, whatever way he takes, lacks something that
    only others of the set could give back.

    waits : name -> the ways out of his waiting, any of which is enough; who is not named waits for nothing
    Source: Holt 1972, Some deadlock properties of computer systems, Computing Surveys 4(3) (reduction of a graph).
    """
    left = set(waits)
    room = {
        name: pool.free + sum(n for who, n in pool.holders.items() if who not in left) for name, pool in pools.items()
    }
    while moving := {who for who in left if any(_can_go(way, room) for way in waits[who])}:
        left -= moving
        for name, pool in pools.items():
            room[name] += sum(n for who, n in pool.holders.items() if who in moving)
    return left


def circles(
    waits: Mapping[str, Collection[Way]], pools: Mapping[str, Pool]
) -> Iterator[tuple[set[str], list[tuple[str, str]]]]:
    """Of each set that waits only for each other: the set, and the shortest circle in it as (who, pool he waits for).

    The one after him in the circle has what he waits for, and the first has what the last waits for. Circles that wait
    for nobody else come alone where there are any.
    """
    inside = stuck(waits, pools)
    wanted = {who: _lacking(who, waits, pools, inside) for who in sorted(inside)}
    graph = {who: {other for _, others in lacks for other in others} for who, lacks in wanted.items()}
    found = list(rings({who: sorted(onward) for who, onward in graph.items()}))
    closed = [ring for ring in found if all(graph[who] <= ring for who in ring)]
    for ring in closed or found:
        yield ring, _shortest(ring, wanted)


def _can_go(way: Way, room: Mapping[str, float]) -> bool:
    return all(room[pool] >= units for pool, units in way)


def _lacking(
    who: str, waits: Mapping[str, Collection[Way]], pools: Mapping[str, Pool], inside: Collection[str]
) -> list[tuple[str, list[str]]]:
    """(pool, those inside who have it) of everything that somebody waits for and cannot get."""
    found: dict[str, list[str]] = {}
    for way in waits[who]:
        for name, units in way:
            pool = pools[name]
            if pool.free + sum(n for other, n in pool.holders.items() if other not in inside) < units:
                found[name] = sorted(other for other in pool.holders if other in inside)
    return list(found.items())


def _shortest(ring: Collection[str], wanted: Mapping[str, list[tuple[str, list[str]]]]) -> list[tuple[str, str]]:
    """The shortest circle through the ring, found from each of it in turn; the first of the shortest."""
    found = [circle for start in sorted(ring) if (circle := _back_to(start, wanted)) is not None]
    return min(found, key=len)


def _back_to(start: str, wanted: Mapping[str, list[tuple[str, list[str]]]]) -> list[tuple[str, str]] | None:
    """The shortest way from somebody along what is waited for back to himself."""
    came: dict[str, tuple[str, str]] = {}
    ahead = deque([start])
    while ahead:
        who = ahead.popleft()
        for pool, others in wanted[who]:
            for other in others:
                if other not in came:
                    came[other] = (who, pool)
                    ahead.append(other)
                if other == start:
                    return _trail(start, came)
    return None


def _trail(start: str, came: Mapping[str, tuple[str, str]]) -> list[tuple[str, str]]:
    steps = [came[start]]
    while steps[-1][0] != start:
        steps.append(came[steps[-1][0]])
    return steps[::-1]
