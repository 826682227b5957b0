"""Keys of candidates are tuples, the smallest wins. The rule that gives most of one may be anybody's."""

from __future__ import annotations

from typing import Any

from opsim.plugins import dispatch_rule


def use_rule(floor: Any, rule: str) -> None:
    """The floor's rule of allocation is the one of a name."""
    floor.rule = dispatch_rule(rule)


def have_room(build: Any) -> None:
    """Keys of any length are there when they are made."""
    build.floor.key = build.floor.best_key = ()


def begin_key(floor: Any) -> None:
    """Nothing is in the key."""
    floor.key = ()


def put(floor: Any, number: float) -> None:
    """One more number of the key."""
    floor.key += (number,)


def is_better(floor: Any) -> bool:
    """Whether the key is smaller than the best so far."""
    return bool(floor.key < floor.best_key)


def keep_best(floor: Any) -> None:
    """The key is the best so far."""
    floor.best_key = floor.key


def pair_numbers(floor: Any, worker: Any, station: Any, n_waiting: float, since_s: float) -> Any:
    """What the plan's rule compares a free worker and a calling station by; somebody calls there since some time."""
    rank = station.rank
    walk_s = worker.walk_s[worker.place * floor.n_stations + rank]
    return floor.rule(n_waiting, since_s, walk_s, worker.rating[rank], rank, worker.rank)


def pair_key(floor: Any, worker: Any, station: Any, job: Any, n_waiting: float, since_s: float) -> None:
    """The key of a free worker and a calling station; ``job`` is the one that calls, since some time."""
    floor.key = ()
    for hook in floor.prefixes:
        hook.line(floor, worker, station, job)
    floor.key += pair_numbers(floor, worker, station, n_waiting, since_s)
