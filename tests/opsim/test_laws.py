"""The audit passes good logs and catches each way of breaking one."""

import numpy as np
import pytest
from plans import CELL, line, plan, queue

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import CHECKS, BrokenLog, audit
from opsim.log import BLOCKED, CREATE, FINISH, HELD, QUEUE, WAIT, WALK, WORK, EventLog


@pytest.fixture(scope="module")
def cell():
    return plan(CELL)


@pytest.fixture(scope="module")
def log(cell):
    return run_plan(cell)


def first(log, kind) -> int:
    """A row of some kind in the middle of the run, one that lasts."""
    rows = np.flatnonzero((log["kind"] == kind) & (log["end_s"] < log.horizon_s))
    return int(rows[len(rows) // 2])


def changed(log, row, **values) -> EventLog:
    columns = {name: column.copy() for name, column in log.columns.items()}
    for name, value in values.items():
        columns[name][row] = value
    return EventLog(log.replication, log.horizon_s, columns, log.names)


def without(log, row) -> EventLog:
    return log.where(np.arange(len(log)) != row)


@pytest.mark.parametrize("text", [CELL, line(3, 0, horizon="3000 s"), queue(horizon="3000 s", servers=3)])
def test_a_run_obeys_every_law(text):
    assert audit(run_plan(plan(text)), plan(text)) == CHECKS


def test_a_job_that_vanishes_is_caught(log, cell):
    with pytest.raises(BrokenLog, match=r"job \d+"):
        audit(without(log, first(log, FINISH)), cell)


def test_a_job_out_of_nowhere_is_caught(log, cell):
    with pytest.raises(BrokenLog, match="never created"):
        audit(without(log, first(log, CREATE)), cell)


def test_a_job_finished_twice_is_caught(log, cell):
    row = first(log, FINISH)
    with pytest.raises(BrokenLog, match="more than once"):
        audit(log.where(np.sort(np.r_[np.arange(len(log)), row])), cell)


@pytest.mark.parametrize("kind", [WORK, WALK, WAIT])
def test_a_worker_who_is_nowhere_is_caught(log, cell, kind):
    with pytest.raises(BrokenLog, match="gap"):
        audit(without(log, first(log, kind)), cell)


def test_a_worker_in_two_places_is_caught(log, cell):
    row = first(log, WAIT)
    with pytest.raises(BrokenLog, match=r"worker \d: overlap"):
        audit(changed(log, row, start_s=log["start_s"][row] - 1), cell)


@pytest.mark.parametrize("kind", [QUEUE, HELD, BLOCKED])
def test_a_gap_in_a_jobs_stay_is_caught(log, cell, kind):
    with pytest.raises(BrokenLog, match=r"job \d+: (gap|rows cover)"):
        audit(without(log, first(log, kind)), cell)


def test_too_many_jobs_on_the_servers_are_caught(log, cell):
    row = first(log, WORK)
    everywhere = np.flatnonzero(np.isin(log["kind"], (WORK, HELD, BLOCKED)))
    with pytest.raises(BrokenLog, match="servers"):
        audit(changed(log, everywhere, station=log["station"][row]), cell)


def test_jobs_that_stay_longer_than_they_are_inside_are_caught(log, cell):
    row = first(log, FINISH)
    with pytest.raises(BrokenLog, match=r"job \d+"):
        audit(changed(log, row, end_s=log["end_s"][row] - 2.0**-20, start_s=log["end_s"][row] - 2.0**-20), cell)
