"""The law of workers: each is somewhere, and in one place."""

from collections.abc import Iterator

import numpy as np

from opsim.laws.stays import Stays, untiled
from opsim.log import WORKER_KINDS, EventLog
from opsim.plan import Plan


def one_state(log: EventLog, plan: Plan, stays: Stays) -> Iterator[str]:
    """A worker's rows follow each other from the start to the horizon."""
    rows = log.where(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    everyone = np.arange(len(plan.workers))
    until = np.full_like(everyone, stays.horizon)
    yield from untiled(rows, rows["worker"], everyone, np.zeros_like(everyone), until, "worker")
