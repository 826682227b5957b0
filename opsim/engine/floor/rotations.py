"""Job rotation: people change posts by the clock, by what was done, or by a rule."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import Handle, cast, inlined, line_of, part_of, step
from opsim.engine.floor.parts.bits import leave_all, leave_those
from opsim.engine.floor.parts.doses import dose_so_far, heaviest_first
from opsim.engine.floor.parts.events import alarm
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.rotating import Counted, Rotation
from opsim.engine.floor.parts.rotation_rules import WIDTH, set_key, use_rule
from opsim.engine.floor.parts.state import FIRST_ROTATION, Floor, Job, Worker
from opsim.engine.floor.posts import one_each
from opsim.engine.rules import CALENDAR
from opsim.log import ABSENT, OFF
from opsim.posts import turns_away

COUNT = 1
"""Among what is asked when an operation is done: it is counted before anything becomes of the job."""

FIRST = -1000
"""Each rotation looks who is there before anybody is sent."""
_turns_away = inlined(turns_away)
_as_rotation = cast(Rotation)


@step
def keep_up(floor: Floor, rotation: Rotation) -> bool:
    """Posts are given out anew where a change is due, or somebody has come or gone."""
    if rotation.due or _others_are_there(rotation):
        if rotation.due:
            rotation.turn += 1
            rotation.due = 0
            for post in range(rotation.n_posts):
                rotation.n_done[post] = 0
        _see_there(floor, rotation)
        _give_out(floor, rotation)
    return False


@inlined
def _others_are_there(rotation: Rotation) -> bool:
    """Whether other members are there than when posts were given out."""
    there, n = rotation.there, 0
    for member in range(rotation.n_members):
        if _is_there(rotation.members[member]):
            if n == len(there) or there[n] != member:
                return True
            n += 1
    return n != len(there)


@inlined
def _is_there(worker: Worker) -> bool:
    """On shift, or in overtime; not who merely finishes something before he goes."""
    return worker.kind != OFF and worker.kind != ABSENT and not worker.going


@inlined
def _see_there(floor: Floor, rotation: Rotation) -> None:
    rotation.there.clear()
    for member in range(rotation.n_members):
        if _is_there(rotation.members[member]):
            rotation.position[member] = len(rotation.there)
            rotation.there.append(member)


@step
def _give_out(floor: Floor, rotation: Rotation) -> None:
    """Everybody is at his post from now on, by the rule."""
    _count_time(floor, rotation)
    n_posts = rotation.n_posts
    _find_posts(floor, rotation)
    for member in range(rotation.n_members):
        post = rotation.found[member]
        if post != rotation.at[member]:
            for other in range(n_posts):
                rotation.here_s[member * n_posts + other] = 0.0
            if post < 0:
                leave_all(floor, rotation.members[member], rotation.limit)
            else:
                leaves = part_of(rotation.leaves, post * floor.n_words)
                leave_those(floor, rotation.members[member], rotation.limit, leaves)
            rotation.at[member] = post


@inlined
def _count_time(floor: Floor, rotation: Rotation) -> None:
    for member in range(rotation.n_members):
        post = rotation.at[member]
        if post >= 0:
            pair = member * rotation.n_posts + post
            rotation.time_s[pair] += floor.now - rotation.since_s
            rotation.here_s[pair] += floor.now - rotation.since_s
    rotation.since_s = floor.now


@step
def _find_posts(floor: Floor, rotation: Rotation) -> None:
    """``rotation.found``: everybody who is there and can be at one of the posts has one (``posts.given_out``)."""
    posts, first = rotation.posts, 0
    for member in range(rotation.n_members):
        rotation.found[member] = -1
    posts.left.clear()
    if not rotation.there:
        return
    _see_doses(floor, rotation)
    for one in rotation.there:
        if _can_be_somewhere(rotation, one):
            posts.left.append(one)
    while posts.left:
        _set_keys(floor, rotation, first)
        one_each(floor, posts)
        n_left = len(posts.left)
        for _ in range(n_left):
            member = posts.left.pop(0)
            if posts.taken[member] >= 0:
                rotation.found[member] = rotation.heaviest[posts.taken[member]]
            else:
                posts.left.append(member)
        first += rotation.n_posts


@inlined
def _can_be_somewhere(rotation: Rotation, member: int) -> bool:
    for post in range(rotation.n_posts):
        if rotation.posts.can[post * rotation.n_members + member]:
            return True
    return False


@inlined
def _see_doses(floor: Floor, rotation: Rotation) -> None:
    """The heaviest post comes first, where that is the rule; and how much each body has gone through so far."""
    if not rotation.by_dose:
        return
    if not rotation.is_known:
        heaviest_first(floor, rotation.members[0], rotation.rank, rotation.heaviest)
        rotation.is_known = 1
        for post in range(rotation.n_posts):
            for member in range(rotation.n_members):
                can = rotation.can[rotation.heaviest[post] * rotation.n_members + member]
                rotation.posts.can[post * rotation.n_members + member] = can
    for member in rotation.there:
        rotation.dose[member] = dose_so_far(floor, rotation.members[member])


@step
def _set_keys(floor: Floor, rotation: Rotation, first: int) -> None:
    """Keys of all who are left for all posts: of slots from ``first`` on, a multiple of the posts there are."""
    posts, n_slots = rotation.posts, max(len(rotation.there), rotation.n_posts)
    for number in range(rotation.n_posts):
        post = rotation.heaviest[number]
        for member in posts.left:
            away = _turns_away(rotation.position[member], rotation.turn, first + post, n_slots)
            set_key(rotation, number, member, post, away)


@step
def changes(floor: Floor, event: Event) -> None:
    """By the clock: a change is due, and the next one to come."""
    rotation: Rotation = _as_rotation(event.subject)
    rotation.due = 1
    set_clock(floor, rotation)


@step
def set_clock(floor: Floor, rotation: Rotation) -> bool:
    """The next change by the clock."""
    if rotation.every_s > 0:
        alarm(floor, rotation.every_s, CALENDAR, rotation.rank, 0, line_of_changes, rotation)
    return True


@step
def count(floor: Floor, counted: Counted, job: Job) -> bool:
    """An operation is done at some of the posts; a change is due where there were enough."""
    rotation = counted.rotation
    for i in range(counted.n):
        post = counted.posts[i]
        rotation.n_done[post] += 1
        if rotation.n_done[post] >= rotation.after:
            rotation.due = 1
    return True


line_of_changes = line_of(changes)


def install(build: Any) -> None:
    """Each rotation hangs in, and its posts are given out when the run begins."""
    for rank, plan in enumerate(build.plan.rotations):
        made = _rotation(build, plan, rank)
        build.line(changes)
        build.hang(build.floor.dispatchers, keep_up, made, FIRST + rank)
        build.hang(build.floor.starts, set_clock, made)
        for station in build.stations if plan.after is not None else ():
            _count_at(build, station, plan, made)


def _rotation(build: Any, plan: Any, rank: int) -> Handle:
    n_posts, n_members, made = len(plan.posts), len(plan.workers), build.arena.new("Rotation")
    made.rank, made.limit = rank, FIRST_ROTATION + rank
    use_rule(made, plan.rule)
    made.every_s, made.after = plan.every_s or 0.0, plan.after or 0
    made.n_members, made.n_posts = n_members, n_posts
    made.members = build.arena.array("Worker", [build.workers[worker] for worker in plan.workers])
    everywhere = (1 << len(build.stations)) - 1
    left = [plan.leaves(post, everywhere) for post in range(n_posts)]
    ranks = range(len(build.stations))
    made.leaves = build.ints(word for bits in left for word in build.bits(r for r in ranks if bits >> r & 1))
    made.position, made.n_done = build.ints([0] * n_members), build.ints([0] * n_posts)
    made.at, made.found = build.ints([-1] * n_members), build.ints([-1] * n_members)
    for name in ("time_s", "here_s"):
        setattr(made, name, build.floats([0.0] * (n_members * n_posts)))
    made.dose, made.heaviest = build.floats([0.0] * n_members), build.ints(range(n_posts))
    can = plan.can(build.plan.workers)
    able = [can(member, post) for post in range(n_posts) for member in range(n_members)]
    made.can, made.posts = build.ints(able), posts_of(build, n_posts, n_members, able)
    return made


def posts_of(build: Any, n_posts: int, n_members: int, able: list[bool]) -> Handle:
    """Room to give posts out. able : by post, then member."""
    made = build.arena.new("Posts")
    made.n_posts, made.n_members, made.width = n_posts, n_members, WIDTH
    made.can, made.keys = build.ints(able), build.floats([0.0] * (n_posts * n_members * WIDTH))
    made.wanted = build.ints([0] * (n_posts * n_members))
    for name in ("n_wanted", "holder", "asked"):
        setattr(made, name, build.ints([0] * n_posts))
    made.taken = build.ints([0] * n_members)
    return made


def _count_at(build: Any, station: Handle, plan: Any, rotation: Handle) -> None:
    """Operations at a station count for the posts that it is part of."""
    posts = [number for number, post in enumerate(plan.posts) if station.rank in post]
    if posts:
        made = build.arena.new("Counted")
        made.rotation, made.n, made.posts = rotation, len(posts), build.ints(posts)
        build.hang(station.afters, count, made, COUNT)
