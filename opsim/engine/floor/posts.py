"""Who is at which post: each post one person who can. See ``opsim.posts``."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.rotating import Posts
from opsim.engine.floor.parts.state import Floor


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
