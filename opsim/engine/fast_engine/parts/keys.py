"""Keys of candidates: compared in their order, the smallest wins. The rules are those of ``engine/rules``, compiled."""

from __future__ import annotations

from typing import Any

from opsim.engine.fast_engine.machine import ask_3, inlined
from opsim.engine.fast_engine.parts.state import Floor, Job, Station, Worker
from opsim.engine.rules import ALLOCATION_RULES, allocation

ALLOCATION = tuple(ALLOCATION_RULES)
"""Rules of allocation by their numbers."""
MOST = 32
"""Numbers in a key at most."""
_longest_queue, _nearest, _oldest_job = map(
    inlined, (allocation.longest_queue, allocation.nearest, allocation.oldest_job)
)
_best_skill, _most_downstream = map(inlined, (allocation.best_skill, allocation.most_downstream))
_least_exposed = inlined(allocation.least_exposed)


def use_rule(floor: Any, rule: str) -> None:
    """The floor's rule of allocation is the one of a name."""
    floor.rule = ALLOCATION.index(rule)


def have_room(build: Any) -> None:
    """Keys have room for the most numbers that there may be."""
    build.floor.key, build.floor.best_key = build.floats([0.0] * MOST), build.floats([0.0] * MOST)


@inlined
def begin_key(floor: Floor) -> None:
    """Nothing is in the key."""
    floor.key_n = 0


@inlined
def put(floor: Floor, number: float) -> None:
    """One more number of the key."""
    floor.key[floor.key_n] = number
    floor.key_n += 1


@inlined
def is_better(floor: Floor) -> bool:
    """Whether the key is smaller than the best so far."""
    for i in range(floor.key_n):
        if floor.key[i] != floor.best_key[i]:
            return floor.key[i] < floor.best_key[i]
    return False


@inlined
def keep_best(floor: Floor) -> None:
    """The key is the best so far."""
    for i in range(floor.key_n):
        floor.best_key[i] = floor.key[i]


@inlined
def pair_numbers(
    floor: Floor, worker: Worker, station: Station, n_waiting: float, since_s: float
) -> tuple[float, float, float, float, float, float]:
    """What the plan's rule compares a free worker and a calling station by; somebody calls there since some time."""
    walk_s, rating = worker.walk_s[worker.place * floor.n_stations + station.rank], worker.rating[station.rank]
    n, at, by = float(n_waiting), float(station.rank), float(worker.rank)
    if floor.rule == 0:
        return _longest_queue(n, since_s, walk_s, rating, at, by)
    if floor.rule == 1:
        return _nearest(n, since_s, walk_s, rating, at, by)
    if floor.rule == 2:
        return _oldest_job(n, since_s, walk_s, rating, at, by)
    if floor.rule == 3:
        return _most_downstream(n, since_s, walk_s, rating, at, by)
    if floor.rule == 4:
        return _best_skill(n, since_s, walk_s, rating, at, by)
    return _least_exposed(n, since_s, walk_s, rating, at, by)


@inlined
def pair_key(floor: Floor, worker: Worker, station: Station, job: Job, n_waiting: float, since_s: float) -> None:
    """The key of a free worker and a calling station; ``job`` is the one that calls, since some time."""
    begin_key(floor)
    for i in range(len(floor.prefixes)):
        ask_3(floor.prefixes[i].line, floor, worker, station, job)
    found = pair_numbers(floor, worker, station, n_waiting, since_s)
    put(floor, found[0])  # NOTE: a loop over them jumps by a table six times
    put(floor, found[1])
    put(floor, found[2])
    put(floor, found[3])
    put(floor, found[4])
    put(floor, found[5])


assert (*("longest_queue", "nearest", "oldest_job", "most_downstream", "best_skill", "least_exposed"),) == ALLOCATION, (
    "pair_numbers has the rules in another order"
)
