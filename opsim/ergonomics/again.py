"""Any performance of an EventLog again, or the piece of it that a row tells of, with the body behind it."""

from __future__ import annotations

import numpy as np

from opsim.clock import on_grid
from opsim.ergonomics.pieces import luck_of
from opsim.log import SETUP, WORK, EventLog
from opsim.own_luck import OwnLuck
from opsim.performance import Drawn, Performance
from opsim.plan import Plan
from opsim.streams import BLOCK


def performance_again(log: EventLog, plan: Plan, row: int) -> Performance:
    """The piece of a performance behind a row of work or set-up of a worker.

    Where human effects shifted its time, the postures follow, from the same noise (``pieces.drawn_again``).
    Its postures are those between its own ``progress_from`` and ``progress_to``: pieces of one performance follow each
    other without a jump; who took over goes on, in a performance of his own, from where the other had come to.
    Raises ValueError where the row is no work of a worker, or where a task's model draws what is no time.
    """
    kind, worker, task, k = (int(log[name][row]) for name in ("kind", "worker", "task", "k"))
    if kind not in (WORK, SETUP) or min(worker, task, k) < 0:
        raise ValueError(f"row {row} is no work of a worker: there is no performance behind it")
    person, named = plan.workers[worker], plan.tasks[task]
    drawn = _drawn(luck_of(plan, worker, log.replication), named.name, k, float(log["pace_shift"][row]))
    begun, done = float(log["progress_from"][row]), float(log["progress_to"][row])
    start_s, end_s = float(log["start_s"][row]), float(log["end_s"][row])
    rating = person.rating[int(log["station"][row])]
    by_row = named.automatic or named.attended or rating <= 0 or (plan.human.changes_times and done > begun)
    whole_s = on_grid((end_s - start_s) / (done - begun) if by_row else drawn.duration_s / rating)
    return Performance(
        person.name,
        named.name,
        k,
        start_s,
        end_s,
        whole_s,
        tuple((drawn.mark_s * (whole_s / drawn.duration_s)).tolist()),
        begun,
        done,
        int(log["performance_id"][row]),
        drawn,
    )


def _drawn(luck: OwnLuck, task: str, k: int, shift: float) -> Drawn:
    """The k-th performance of a task, with the postures that go with a shift of its log time."""
    if not shift:
        return luck.performance(task, k)
    shifts = np.zeros(BLOCK)
    shifts[k % BLOCK] = shift
    return Drawn(luck.slowed(task, k // BLOCK, shifts), k % BLOCK)
