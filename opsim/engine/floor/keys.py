"""Keys of candidates are tuples, the smallest wins: of workers, of jobs in a queue, of members for a post.

The rule that gives most of one may be anybody's.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.rules import LEAST_EXPOSED, less_gone_through, queue_key
from opsim.plugins import dispatch_rule, rule_of


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


def queue_rule(rule: str) -> Any:
    """The rule of a name by which the next job of a queue is chosen."""
    return rule_of("opsim.sequencing", rule)


def routing_rule(rule: str) -> Any:
    """The rule of a name by which one of several stations is chosen."""
    return rule_of("opsim.routing", rule)


def put_queue_key(
    floor: Any, rule: Any, job: Any, work_s: float, left_s: float, left_steps: float, setup_s: float, goes_on: bool
) -> None:
    """The key of a job in a queue."""
    key = rule(floor.now, job.since_s, work_s, left_s, left_steps, job.due_s, setup_s, job.number)
    floor.key = queue_key(job.priority, goes_on, *key)


def put_station_key(
    floor: Any, rule: Any, station: Any, mean_s: float, setup_s: float, distance_m: float, position: int
) -> None:
    """The key of a station for a job."""
    n_inside, n_free = station.n_inside - len(station.put_away), station.free_servers
    floor.key = rule(n_inside, station.servers, station.rank, n_free, mean_s, setup_s, distance_m, position)


def keep_key(floor: Any, job: Any) -> None:
    """The key of the job is the one that was put just now."""
    job.block.queue_key = floor.key


def comes_before(one: Any, other: Any) -> bool:
    """Whether one job of the queue is served before another, by their keys."""
    return bool(one.block.queue_key < other.block.queue_key)


WIDTH = 1
"""Of a key, which is a tuple here."""


def use_rotation_rule(made: Any, rule: str) -> None:
    """A rotation's rule is the one of a name."""
    made.rule, made.by_dose = rule_of("opsim.rotation", rule), rule == LEAST_EXPOSED


def set_key(rotation: Any, number: int, member: int, post: int, away: int) -> None:
    """The key of a member for a post, which is the ``number``-th that is given out; ``away`` : turns from his own."""
    pair = member * rotation.n_posts + post
    key = rotation.rule(away, rotation.time_s[pair], rotation.here_s[pair], member)
    if rotation.by_dose:
        key = (*less_gone_through(rotation.dose[member]), *key)
    rotation.posts.keys[number * rotation.n_members + member] = key
