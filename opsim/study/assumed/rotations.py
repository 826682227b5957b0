"""What the sheet says of job rotation."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.evenness import LEAST_EXPOSED
from opsim.plan.rotations import IN_TURN, RotationPlan


def rotations(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of each rotation."""
    new = ", and nobody is slower for being new at a post" if plan.human.learning is None else ""
    for rotation in plan.rotations:
        names = listed([plan.workers[worker].name for worker in rotation.workers])
        yield (
            "rotation",
            f"{rotation.name}: {names} share {len(rotation.posts)} posts, and change {_when(rotation)}, "
            f"{_who(rotation)}; what was begun is finished at the old post, a change takes no time but the walk{new}",
        )


def _when(rotation: RotationPlan) -> str:
    if rotation.every_s is not None:
        return f"every {rotation.every_s / 3600:g} h from the start of the run, work time or not"
    if rotation.after == 1:
        return "after every operation at one of the posts"
    return f"when {rotation.after} operations were done at one of the posts, by whomever"


def _who(rotation: RotationPlan) -> str:
    if rotation.rule == IN_TURN:
        return "each to the next post"
    if rotation.rule == "least_time":
        return "a post going to who was there for the shortest time so far, breaks included"
    if rotation.rule == LEAST_EXPOSED:
        return "the heaviest post going to whose body has gone through least so far"
    return f"by the rule {rotation.rule}"
