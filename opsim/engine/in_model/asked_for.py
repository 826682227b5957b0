"""Jobs that somebody's model asks a floor for, beside those of its sources; and what becomes of jobs."""

from __future__ import annotations

from collections.abc import Callable
from heapq import heappush
from typing import Any

from opsim.engine.floor.machine.structs import STRUCTS
from opsim.engine.floor.material import new_job
from opsim.engine.floor.parts.gates import want_in
from opsim.engine.floor.parts.heap import new_event
from opsim.engine.rules import ARRIVAL
from opsim.log import pack_row, row
from opsim.plan import Plan
from opsim.plan.release import INSIDE, SCHEDULE

FIRST, APART = 2**40, 2**32
"""Jobs that are asked for have numbers of their own in their source: the draws of all other jobs stay as they are."""
_ROW_BYTES = len(pack_row(*row(0, 0.0, 0.0)))


def source_for(plan: Plan, product: int) -> int:
    """The rank of the source whose jobs those of a product are that are asked for; -1 where none makes it.

    The first in natural order that makes it; one with a schedule, or whose jobs come of others, only where there is no
    other.
    """
    able = [rank for rank, one in enumerate(plan.sources) if any(made == product for made, _ in one.mix)]
    return min(able, key=lambda rank: (plan.sources[rank].kind in (INSIDE, SCHEDULE), rank), default=-1)


def ask_for(floor: Any, product: int, rank: int, n: int, created: Callable[[Any], None], at_s: float) -> None:
    """One more job of a product, the n-th that a source of a rank is asked for, comes at a time of the floor's clock.

    created : is told the job, as it comes
    """
    source, number = floor.sources[rank], FIRST + APART * rank + n

    def comes(floor: Any, _event: Any) -> None:
        n_released = source.n_released
        job = new_job(floor, source, product, number, -1, -1)
        source.n_released = n_released
        created(job)
        want_in(floor, job, floor.now)

    def reported(event: Any) -> None:
        floor.env_now = floor.env.now
        floor.report_line(floor, event)

    event = new_event(floor)
    event.line, event.alive, event.kind, event.rank, event.number = comes, 1, ARRIVAL, rank, number
    event.callbacks.append(reported)
    heappush(floor.env._queue, (at_s, 1, next(floor.env._eid), event))


def watch(floor: Any, came: Callable[[Any], None], left: Callable[[Any, int, int], None]) -> None:
    """Have each job told as it comes, and as it leaves, with the kind and the cause of the row that says so."""

    def leaves(floor: Any, _subject: Any, job: Any) -> None:
        # NOTE: the row is the last one written, and kind and cause are its first and its last byte.
        left(job, floor.log.rows[-_ROW_BYTES], floor.log.rows[-1])

    floor.created.insert(0, _hook(lambda _floor, _subject, job: came(job)))
    floor.left_floor.insert(0, _hook(leaves))


def _hook(line: Any) -> Any:
    made = STRUCTS["Hook"]()
    made.line = line
    return made
