"""Keys of candidates: compared in their order, the smallest wins. The rules are those of ``engine/rules``, compiled."""

from __future__ import annotations

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
def pair_key(floor: Floor, worker: Worker, station: Station, job: Job, n_waiting: float, since_s: float) -> None:
    """What a free worker and a calling station are compared by; ``job`` is the one that calls, since some time."""
    floor.key_n = 0
    for i in range(len(floor.prefixes)):
        ask_3(floor.prefixes[i].line, floor, worker, station, job)
    n_stations, rank = floor.n_stations, station.rank
    walk_s, rating = worker.walk_s[worker.place * n_stations + rank], worker.rating[rank]
    at, by = float(rank), float(worker.rank)
    n = float(n_waiting)
    if floor.rule == 0:
        found = _longest_queue(n, since_s, walk_s, rating, at, by)
    elif floor.rule == 1:
        found = _nearest(n, since_s, walk_s, rating, at, by)
    elif floor.rule == 2:
        found = _oldest_job(n, since_s, walk_s, rating, at, by)
    elif floor.rule == 3:
        found = _most_downstream(n, since_s, walk_s, rating, at, by)
    elif floor.rule == 4:
        found = _best_skill(n, since_s, walk_s, rating, at, by)
    else:
        found = _least_exposed(n, since_s, walk_s, rating, at, by)
    for i in range(6):
        floor.key[floor.key_n + i] = found[i]
    floor.key_n += 6


assert (*("longest_queue", "nearest", "oldest_job", "most_downstream", "best_skill", "least_exposed"),) == ALLOCATION, (
    "pair_key has the rules in another order"
)
