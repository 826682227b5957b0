"""Keys by which jobs of a queue are put in order, kept at the jobs."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import inlined, new_floats
from opsim.engine.fast_engine.parts.state import Floor, Job

KEY = 6
"""Numbers in the key of a queue at most, and how many these are."""


@inlined
def keep_key(floor: Floor, job: Job) -> None:
    """The key of the job is the one that was put just now."""
    block = job.block
    if not block.queue_key:
        block.queue_key = new_floats(floor, KEY)
    block.queue_key[KEY - 1] = float(floor.key_n)
    for i in range(floor.key_n):
        block.queue_key[i] = floor.key[i]


@inlined
def comes_before(one: Job, other: Job) -> bool:
    """Whether one job of the queue is served before another, by their keys."""
    key, other_key = one.block.queue_key, other.block.queue_key
    for i in range(int(key[KEY - 1])):
        if key[i] != other_key[i]:
            return key[i] < other_key[i]
    return False
