"""opsim's fast engine, event log on: replications of one Plan, as a study runs them, and the figure from their logs.

A seed is the number of a replication; ``numbers`` are those it will use, so that its answers can be exact too.
"""

from functools import cache

import numpy as np
from bench.peers import in_opsim
from bench.peers.times import Given

from opsim.engine.fast_engine.run import Machine
from opsim.log import CREATE, FINISH, EventLog


def mm1(until_s, seed):
    return _times(_run("mm1", until_s, seed))


def mm1_manned(until_s, seed):
    return _times(_run("mm1_manned", until_s, seed))


def line(until_s, seed):
    return _rate(_run("line", until_s, seed))


def line_manned(until_s, seed):
    return _rate(_run("line_manned", until_s, seed))


def pool(until_s, seed):
    return _times(_run("pool", until_s, seed))


def numbers(variant: str, until_s: float, seed: int, n: int) -> Given:
    """The first n numbers of each kind that ``variant(until_s, seed)`` uses, on the engine's grid of time."""
    return in_opsim.numbers_of(_machine(variant, until_s).plan, seed, n)


def _run(variant: str, until_s: float, replication: int) -> EventLog:
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1, user_api="blas"):
        return _machine(variant, until_s).run(replication)


@cache
def _machine(variant: str, until_s: float) -> Machine:
    """NOTE: ``fast_engine.run_plan`` keeps those of the last two Plans only; here all take turns."""
    return Machine(in_opsim.PLANS[variant](until_s, 1))


def _times(log: EventLog) -> tuple[int, float]:
    """Jobs finished, and their mean time from coming in to leaving. Jobs have numbers from 0 or 1 on."""
    kinds, jobs, ends_s = log["kind"], log["job"], log["end_s"]
    created, finished = (np.flatnonzero(kinds == kind) for kind in (CREATE, FINISH))
    came_s = np.empty(jobs[created].max() + 1)
    came_s[jobs[created]] = ends_s[created]
    return finished.size, float((ends_s[finished] - came_s[jobs[finished]]).mean())


def _rate(log: EventLog) -> tuple[int, float]:
    finished = int(np.count_nonzero(log["kind"] == FINISH))
    return finished, finished / log.horizon_s
