"""Job rotation: people change posts by the clock, by what was done, or by a rule; each post gets one who can."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import FIRST_ROTATION, Floor
from opsim.engine.floor.keys import WIDTH, set_key, use_rotation_rule
from opsim.engine.floor.machine import Array, Handle, List, cast, inlined, line_of, part_of, step, struct
from opsim.engine.floor.state import Event, Job, Worker
from opsim.engine.rules import CALENDAR
from opsim.layout import turns_away
from opsim.log import ABSENT, OFF
from opsim.subjects.human.human_state import dose_so_far, heaviest_first
from opsim.subjects.people.worker import leave_all, leave_those
from opsim.subjects.routes.routing import alarm


@struct
class Posts:
    """One person each for some posts, see ``opsim.layout``. Pairs are by post, then by member.

    can : pairs; width : numbers in a key; keys : pairs, that many numbers each
    left : members without a post, in order; wanted : by post, members by their keys, n_wanted of them
    holder : by post, the member or -1; taken : by member, the post or -1; asked : by post, whether it was asked
    in_turn : posts in the order in which they are filled
    """

    n_posts: int
    n_members: int
    can: Array[int]
    width: int
    keys: Array[float]
    left: List[int]
    wanted: Array[int]
    n_wanted: Array[int]
    holder: Array[int]
    taken: Array[int]
    asked: Array[int]
    in_turn: List[int]


@struct
class Rotation:
    """limit : its number among limits; rule : as ``keys`` knows it

    by_dose : whether the rule evens doses out

    can : by post, then member; leaves : by post, n_words of stations as bits
    every_s : 0 where not by the clock; after : operations, 0 where they are not counted
    there, position : members who are there, in order, and by member where he is in that list
    at : by member, the post or -1; found : the same, from now on
    n_done : by post; time_s, here_s : by member, then post; dose : by member
    heaviest : posts by how heavy they are, once a rule has asked, which is_known then; else as they stand
    """

    rank: int
    limit: int
    rule: int
    by_dose: int
    every_s: float
    after: int
    n_members: int
    members: Array[Worker]
    n_posts: int
    can: Array[int]
    leaves: Array[int]
    turn: int
    due: int
    there: List[int]
    position: Array[int]
    at: Array[int]
    found: Array[int]
    since_s: float
    n_done: Array[int]
    time_s: Array[float]
    here_s: Array[float]
    dose: Array[float]
    is_known: int
    heaviest: Array[int]
    posts: Posts


@struct
class Counted:
    """Operations at a station count for the n posts that it is part of."""

    rotation: Rotation
    n: int
    posts: Array[int]


@step
def one_each(floor: Floor, posts: Posts) -> None:
    """One person of those who are left at each post, by their keys; the first posts first. See ``posts.taken``."""
    for person in range(posts.n_members):
        posts.taken[person] = -1
    posts.in_turn.clear()
    for post in range(posts.n_posts):
        posts.holder[post] = -1
        _sort_wanted(posts, post)
        if posts.n_wanted[post]:
            posts.in_turn.append(post)
    if len(posts.left) < posts.n_posts:
        _sort_posts(floor, posts)
    for one in posts.in_turn:
        for post in range(posts.n_posts):
            posts.asked[post] = 0
        fill(floor, posts, one)


@step
def fill(floor: Floor, posts: Posts, post: int) -> bool:
    """Somebody is found for a post: one without a post, or one whose post somebody else takes."""
    first = post * posts.n_members
    for i in range(posts.n_wanted[post]):
        person = posts.wanted[first + i]
        if posts.taken[person] < 0:
            _take(posts, post, person)
            return True
    for i in range(posts.n_wanted[post]):
        person = posts.wanted[first + i]
        other = posts.taken[person]
        if not posts.asked[other]:
            posts.asked[other] = 1
            if fill(floor, posts, other):
                _take(posts, post, person)
                return True
    return False


@inlined
def _take(posts: Posts, post: int, person: int) -> None:
    posts.holder[post], posts.taken[person] = person, post


@inlined
def _is_before(posts: Posts, one: int, other: int) -> bool:
    """Whether a pair's key is the smaller one. Pairs are numbers: of a post and a person."""
    for i in range(posts.width):
        if posts.keys[one * posts.width + i] != posts.keys[other * posts.width + i]:
            return posts.keys[one * posts.width + i] < posts.keys[other * posts.width + i]
    return False


@inlined
def _sort_wanted(posts: Posts, post: int) -> None:
    """Those who are left and can be at a post, by their keys."""
    first, n = post * posts.n_members, 0
    for person in posts.left:
        if posts.can[first + person]:
            at = n
            while at > 0 and _is_before(posts, first + person, first + posts.wanted[first + at - 1]):
                posts.wanted[first + at] = posts.wanted[first + at - 1]
                at -= 1
            posts.wanted[first + at] = person
            n += 1
    posts.n_wanted[post] = n


@inlined
def _sort_posts(floor: Floor, posts: Posts) -> None:
    """Those whose first choice has the smallest key come first."""
    n = len(posts.in_turn)
    for i in range(1, n):
        post, at = posts.in_turn[i], i
        while at > 0 and _is_before(posts, _first_choice(posts, post), _first_choice(posts, posts.in_turn[at - 1])):
            posts.in_turn[at] = posts.in_turn[at - 1]
            at -= 1
        posts.in_turn[at] = post


@inlined
def _first_choice(posts: Posts, post: int) -> int:
    """The pair of a post and whoever comes first there."""
    return post * posts.n_members + posts.wanted[post * posts.n_members]


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
    use_rotation_rule(made, plan.rule)
    made.every_s, made.after = plan.every_s or 0.0, plan.after or 0
    made.n_members, made.n_posts = n_members, n_posts
    made.members = build.arena.array("Worker", [build.workers[worker] for worker in plan.workers])
    everywhere = (1 << len(build.stations)) - 1
    left = [plan.leaves(post, everywhere) for post in range(n_posts)]
    ranks = range(len(build.stations))
    made.leaves = build.ints(word for bits in left for word in build.bits(r for r in ranks if bits >> r & 1))
    made.position, made.n_done = build.ints([0] * n_members), build.ints([0] * n_posts)
    made.at, made.found = build.ints([-1] * n_members), build.ints([-1] * n_members)
    made.time_s, made.here_s = (build.floats([0.0] * (n_members * n_posts)) for _ in range(2))
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
    made.n_wanted, made.holder, made.asked = (build.ints([0] * n_posts) for _ in range(3))
    made.taken = build.ints([0] * n_members)
    return made


def _count_at(build: Any, station: Handle, plan: Any, rotation: Handle) -> None:
    """Operations at a station count for the posts that it is part of."""
    posts = [number for number, post in enumerate(plan.posts) if station.rank in post]
    if posts:
        made = build.arena.new("Counted")
        made.rotation, made.n, made.posts = rotation, len(posts), build.ints(posts)
        build.hang(station.afters, count, made, COUNT)
