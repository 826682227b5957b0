"""What job rotations know: who is at which post, for how long, and by what rule they change."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, List, struct
from opsim.engine.floor.parts.state import Worker


@struct
class Posts:
    """One person each for some posts, see ``opsim.posts``. Pairs are by post, then by member.

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
    """See ``rotations``. limit : its number among limits; rule : see ``rotation_rules``

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
