"""Who takes a post when people change posts: every member who can gets a key, the smallest goes there.

Posts are given out one after the other. ``turns_away`` says how many changes from now it would be his by turns, 0: now;
``at_post_s`` how long he has been at this post so far in the run, ``here_s`` for how long he has just been there
without a change, 0 where he is elsewhere; ``member`` is his number in the list of those who are there.
"""


def in_turn(turns_away, at_post_s, here_s, member):
    """Everybody moves up by one post."""
    return (turns_away, member)


def least_time(turns_away, at_post_s, here_s, member):
    """Who was at the post for the shortest time so far; of several whose turn comes first."""
    return (at_post_s, turns_away, member)


def least_exposed(turns_away, at_post_s, here_s, member):
    """Posts by how heavy they are, each to whose body has gone through least so far, by ``less_gone_through``, which
    comes before; of several to the one whose turn comes first.
    """
    return (turns_away, member)


ROTATION_RULES = {"in_turn": in_turn, "least_time": least_time, "least_exposed": least_exposed}
