"""Keys of candidates: compared in their order, the smallest wins. The rules are those of ``engine.rules``, compiled."""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.fast_engine.floor_state import Floor
from opsim.engine.fast_engine.machine import inlined, new_floats
from opsim.engine.fast_engine.state import Job, Station, Worker
from opsim.engine.rules import ALLOCATION_RULES, LEAST_EXPOSED, ROTATION_RULES, ROUTING_RULES, SEQUENCING_RULES

ALLOCATION = tuple(ALLOCATION_RULES)
"""Rules of allocation by their numbers."""
MOST = 32
"""Numbers in a key at most."""
_longest_queue, _nearest, _oldest_job = map(inlined, (rules.longest_queue, rules.nearest, rules.oldest_job))
_best_skill, _most_downstream = map(inlined, (rules.best_skill, rules.most_downstream))
_least_exposed = inlined(rules.least_exposed)


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
        floor.prefixes[i].line(floor, worker, station, job)
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


SEQUENCING, ROUTING = tuple(SEQUENCING_RULES), tuple(ROUTING_RULES)
"""Rules of queues, and of several stations, by their numbers."""
_fifo, _spt, _edd = map(inlined, (rules.fifo, rules.spt, rules.edd))
_critical_ratio, _least_setup = inlined(rules.critical_ratio), inlined(rules.least_setup)
_downstream_first = inlined(rules.downstream_first)
_queue_key = inlined(rules.queue_key)
_shortest_queue, _least_loaded = inlined(rules.shortest_queue), inlined(rules.least_loaded)
_first_free, _in_order = inlined(rules.first_free), inlined(rules.in_order)


def queue_rule(rule: str) -> int:
    """The rule of a name by which the next job of a queue is chosen."""
    return SEQUENCING.index(rule)


def routing_rule(rule: str) -> int:
    """The rule of a name by which one of several stations is chosen."""
    return ROUTING.index(rule)


@inlined
def put_queue_key(
    floor: Floor, rule: int, job: Job, work_s: float, left_s: float, left_steps: float, setup_s: float, goes_on: bool
) -> None:
    """The key of a job in a queue."""
    now, since_s, due_s, number = floor.now, job.since_s, job.due_s, float(job.number)
    begin_key(floor)
    if rule == 0:
        key = _fifo(now, since_s, work_s, left_s, left_steps, due_s, setup_s, number)
        first = _queue_key(job.priority, goes_on, key[0], key[1])
        put(floor, first[0])
        put(floor, 1.0 if first[1] else 0.0)
        put(floor, first[2])
        put(floor, first[3])
        return
    if rule == 1:
        found = _spt(now, since_s, work_s, left_s, left_steps, due_s, setup_s, number)
    elif rule == 2:
        found = _edd(now, since_s, work_s, left_s, left_steps, due_s, setup_s, number)
    elif rule == 3:
        found = _critical_ratio(now, since_s, work_s, left_s, left_steps, due_s, setup_s, number)
    elif rule == 4:
        found = _least_setup(now, since_s, work_s, left_s, left_steps, due_s, setup_s, number)
    else:
        found = _downstream_first(now, since_s, work_s, left_s, left_steps, due_s, setup_s, number)
    whole = _queue_key(job.priority, goes_on, found[0], found[1], found[2])
    put(floor, whole[0])
    put(floor, 1.0 if whole[1] else 0.0)
    put(floor, whole[2])
    put(floor, whole[3])
    put(floor, whole[4])


@inlined
def put_station_key(
    floor: Floor, rule: int, station: Station, mean_s: float, setup_s: float, distance_m: float, position: int
) -> None:
    """The key of a station for a job."""
    n_inside, servers = float(station.n_inside - len(station.put_away)), float(station.servers)
    rank, n_free, place = float(station.rank), float(station.free_servers), float(position)
    if rule == 2:
        first = _first_free(n_inside, servers, rank, n_free, mean_s, setup_s, distance_m, place)
        put(floor, first[0])
        put(floor, first[1])
        put(floor, first[2])
        return
    if rule == 0:
        key = _shortest_queue(n_inside, servers, rank, n_free, mean_s, setup_s, distance_m, place)
    elif rule == 1:
        key = _least_loaded(n_inside, servers, rank, n_free, mean_s, setup_s, distance_m, place)
    else:
        key = _in_order(n_inside, servers, rank, n_free, mean_s, setup_s, distance_m, place)
    put(floor, key[0])
    put(floor, key[1])


assert SEQUENCING == ("fifo", "spt", "edd", "critical_ratio", "least_setup", "downstream_first"), "see put_queue_key"
assert ROUTING == ("shortest_queue", "least_loaded", "first_free", "in_order"), "see put_station_key"
KEY = 6
"""Numbers in the key of a queue at most, and how many these are."""


@inlined
def keep_key(floor: Floor, job: Job) -> None:
    """The key of the job is the one that was put just now."""
    block = job.block
    if not block.queue_key:
        block.queue_key = new_floats(floor, KEY)
    block.queue_key[KEY - 1] = float(floor.key_n)
    for i in range(floor.key_n):
        block.queue_key[i] = floor.key[i]


@inlined
def comes_before(one: Job, other: Job) -> bool:
    """Whether one job of the queue is served before another, by their keys."""
    key, other_key = one.block.queue_key, other.block.queue_key
    for i in range(int(key[KEY - 1])):
        if key[i] != other_key[i]:
            return key[i] < other_key[i]
    return False


RULES = tuple(ROTATION_RULES)
"""Rules of rotation by their numbers."""
IN_TURN, LEAST_TIME, BY_DOSE = range(3)
WIDTH = 3
"""Numbers in a key."""
_in_turn, _least_time = inlined(rules.in_turn), inlined(rules.least_time)
_least_exposed_member = inlined(rules.least_exposed_member)
_less_gone_through = inlined(rules.less_gone_through)


def use_rotation_rule(made: Any, rule: str) -> None:
    """A rotation's rule is the one of a name."""
    made.rule, made.by_dose = RULES.index(rule), rule == LEAST_EXPOSED


@inlined
def set_key(rotation: Any, number: int, member: int, post: int, away: int) -> None:
    """The key of a member for a post, which is the ``number``-th that is given out; ``away`` : turns from his own."""
    keys, pair = rotation.posts.keys, member * rotation.n_posts + post
    at = (number * rotation.n_members + member) * WIDTH
    time_s, here_s = rotation.time_s[pair], rotation.here_s[pair]
    if rotation.rule == LEAST_TIME:
        keys[at], keys[at + 1], keys[at + 2] = _least_time(float(away), time_s, here_s, float(member))
    elif rotation.rule == IN_TURN:
        keys[at], keys[at + 1] = _in_turn(float(away), time_s, here_s, float(member))
    else:
        keys[at] = _less_gone_through(rotation.dose[member])[0]
        keys[at + 1], keys[at + 2] = _least_exposed_member(float(away), time_s, here_s, float(member))


assert (RULES[IN_TURN], RULES[LEAST_TIME], RULES[BY_DOSE]) == ("in_turn", "least_time", LEAST_EXPOSED), RULES
