"""Who is at which post: each post one person who can, then each a second one, until everybody has a post."""

from __future__ import annotations

from collections.abc import Callable, Sequence

Key = Callable[[int, int], tuple[float, ...]]


def given_out(n_posts: int, people: Sequence[int], can: Callable[[int, int], bool], key: Key) -> dict[int, int]:
    """{person: post}. Everybody who can be at one of the posts has one.

    people : numbers, in the order of their list; can(person, post) : whether he can be there
    key(person, slot) : the smallest goes first; slot n_posts + j is post j for the second time, and so on. Where there
    are more posts than people, those with the smallest keys are manned.
    No post is empty while another one is double, unless nobody who is left can be there: where only somebody who has a
    post already can, he moves, and another one takes his (augmenting ways, Kuhn 1955).
    """
    at: dict[int, int] = {}
    left, first = [person for person in people if any(can(person, post) for post in range(n_posts))], 0
    while left:
        at.update(_one_each(n_posts, left, can, key, first))
        left, first = [person for person in left if person not in at], first + n_posts
    return at


def turns_away(member: int, turn: int, slot: int, n_slots: int) -> int:
    """How many changes from now a slot is that of the n-th of those who are there, by turns; 0: it is now.

    n_slots : people who are there, or posts, whichever are more: all of them are gone through.
    """
    return (slot - member - turn) % n_slots


def _one_each(n_posts: int, left: Sequence[int], can, key: Key, first: int) -> dict[int, int]:
    """{person: post} with one person at each post, the first posts first."""
    holder: dict[int, int] = {}
    keys = [{person: key(person, first + post) for person in left if can(person, post)} for post in range(n_posts)]
    wanted = [sorted(mine, key=mine.__getitem__) for mine in keys]
    posts = [post for post in range(n_posts) if wanted[post]]
    if len(left) < n_posts:
        posts.sort(key=lambda post: keys[post][wanted[post][0]])
    for post in posts:
        _fill(post, wanted, holder, set())
    return {person: post for post, person in holder.items()}


def _fill(post: int, wanted: list[list[int]], holder: dict[int, int], asked: set[int]) -> bool:
    """Somebody is found for a post: one without a post, or one whose post somebody else takes."""
    taken = {person: other for other, person in holder.items()}
    for person in wanted[post]:
        if person not in taken:
            holder[post] = person
            return True
    for person in wanted[post]:
        other = taken[person]
        if other not in asked:
            asked.add(other)
            if _fill(other, wanted, holder, asked):
                holder[post] = person
                return True
    return False
