"""Keys by which jobs of a queue are put in order, kept at the jobs."""

from typing import Any


def keep_key(floor: Any, job: Any) -> None:
    """The key of the job is the one that was put just now."""
    job.block.queue_key = floor.key


def comes_before(one: Any, other: Any) -> bool:
    """Whether one job of the queue is served before another, by their keys."""
    return bool(one.block.queue_key < other.block.queue_key)
