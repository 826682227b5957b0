"""Rules of job rotation, compiled: the key by which a member takes a post."""

from __future__ import annotations

from typing import Any

from opsim.engine.fast_engine.machine import inlined
from opsim.engine.fast_engine.parts.rotating import Rotation
from opsim.engine.rules import allocation, rotation
from opsim.engine.rules.rotation import ROTATION_RULES
from opsim.plan.evenness import LEAST_EXPOSED

RULES = tuple(ROTATION_RULES)
"""Rules of rotation by their numbers."""
IN_TURN, LEAST_TIME, BY_DOSE = range(3)
WIDTH = 3
"""Numbers in a key."""
_in_turn, _least_time = inlined(rotation.in_turn), inlined(rotation.least_time)
_least_exposed = inlined(rotation.least_exposed)
_less_gone_through = inlined(allocation.less_gone_through)


def use_rule(made: Any, rule: str) -> None:
    """A rotation's rule is the one of a name."""
    made.rule, made.by_dose = RULES.index(rule), rule == LEAST_EXPOSED


@inlined
def set_key(rotation: Rotation, number: int, member: int, post: int, away: int) -> None:
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
        keys[at + 1], keys[at + 2] = _least_exposed(float(away), time_s, here_s, float(member))


assert (RULES[IN_TURN], RULES[LEAST_TIME], RULES[BY_DOSE]) == ("in_turn", "least_time", LEAST_EXPOSED), RULES
