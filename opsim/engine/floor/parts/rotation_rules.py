"""Rules of job rotation, ours as anybody's: the key by which a member takes a post."""

from __future__ import annotations

from typing import Any

from opsim.engine.rules.allocation import less_gone_through
from opsim.plan.evenness import LEAST_EXPOSED
from opsim.plugins import rule_of

WIDTH = 1
"""Of a key, which is a tuple here."""


def use_rule(made: Any, rule: str) -> None:
    """A rotation's rule is the one of a name."""
    made.rule, made.by_dose = rule_of("opsim.rotation", rule), rule == LEAST_EXPOSED


def set_key(rotation: Any, number: int, member: int, post: int, away: int) -> None:
    """The key of a member for a post, which is the ``number``-th that is given out; ``away`` : turns from his own."""
    pair = member * rotation.n_posts + post
    key = rotation.rule(away, rotation.time_s[pair], rotation.here_s[pair], member)
    if rotation.by_dose:
        key = (*less_gone_through(rotation.dose[member]), *key)
    rotation.posts.keys[number * rotation.n_members + member] = key
