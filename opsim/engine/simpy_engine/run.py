"""Plan -> EventLog, one replication."""

from heapq import heappop

import simpy

from opsim.engine.simpy_engine.blocks import HANDLERS, INSTALL
from opsim.engine.simpy_engine.draws import Draws
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.settle import dispatch
from opsim.engine.simpy_engine.worker import log_worker, set_free, working_life
from opsim.log import EventLog, names_of
from opsim.plan import Plan


def run_plan(plan: Plan, replication: int = 0) -> EventLog:
    """Run a Plan to its horizon (exclusive); rows that are open there are closed there, with their progress.

    Draws use one BLAS thread, so that the same seed gives the same bytes on any machine load and number of processes.
    """
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1, user_api="blas"):
        floor = _open(plan, replication)
        _run(floor.env, plan.horizon_s)
    return _close(floor, replication)


def _run(env: simpy.Environment, until_s: float) -> None:
    """Everything that happens before a time.

    NOTE: what ``env.run(until=...)`` does, with ``Environment.step`` written out: 5 % of a run.
    """
    queue = env._queue
    while queue and queue[0][0] < until_s:
        env._now, _, _, event = heappop(queue)
        callbacks, event.callbacks = event.callbacks, None  # type: ignore[assignment]
        for callback in callbacks:
            callback(event)
        if not event._ok and not hasattr(event, "_defused"):
            raise event._value


def _open(plan: Plan, replication: int) -> Floor:
    env = simpy.Environment()
    floor = Floor(env, plan, Draws(plan, replication), HANDLERS, dispatch)
    for worker in floor.workers:
        set_free(floor, worker)
        worker.process = env.process(working_life(floor, worker))
    for install in INSTALL:
        install(floor)
    floor.wake()
    return floor


def _close(floor: Floor, replication: int) -> EventLog:
    floor.now = floor.plan.horizon_s
    for close in floor.closing:
        close(floor)
    for worker in floor.workers:
        log_worker(floor, worker)
    for job in floor.jobs.values():
        floor.log_job(job)
    return floor.log.close(replication, floor.plan.horizon_s, names_of(floor.plan))
