import numpy as np
import pytest

from opsim.export.tables import at_time, performance_of, walk_of
from opsim.history import walk_rows
from opsim.log import SETUP, WALK, WORK, WORKER_KINDS
from tests.opsim.export.made_export import ran


@pytest.fixture(scope="module")
def done():
    return ran("two_shift_plant", "4 h")


def test_a_performance_is_all_its_pieces_in_order(done):
    log, plan = done
    work = np.flatnonzero((log["kind"] == WORK) & (log["worker"] >= 0) & (log["k"] >= 0))
    for row in work[::50].tolist():
        worker, task = plan.workers[log["worker"][row]].name, plan.tasks[log["task"][row]].name
        which = performance_of(log, plan, worker, task, int(log["k"][row]))
        assert row in which.rows.tolist() and not which.walk
        assert np.all(np.diff(log["start_s"][which.rows]) > 0)
        assert np.all(log["progress_from"][which.rows[1:]] == log["progress_to"][which.rows[:-1]])


def test_walks_are_counted_as_they_are_drawn(done):
    log, plan = done
    rows = walk_rows(log)
    for worker in plan.workers[:3]:
        own = rows[log["worker"][rows] == plan.workers.index(worker)]
        if own.size:
            assert walk_of(log, plan, worker.name, own.size - 1).rows.tolist() == [own[-1]]
            with pytest.raises(ValueError, match=f"0 to {own.size - 1}"):
                walk_of(log, plan, worker.name, own.size)


def test_at_a_time_it_is_what_the_worker_does_then_and_at_an_edge_what_begins(done):
    log, plan = done
    rows = np.flatnonzero(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    seen = set()
    for row in rows[::17].tolist():
        worker, start_s, end_s = plan.workers[log["worker"][row]].name, log["start_s"][row], log["end_s"][row]
        for time_s in (float(start_s), float((start_s + end_s) / 2)):
            if log["kind"][row] in (WORK, SETUP, WALK):
                which = at_time(log, plan, worker, time_s)
                assert row in which.rows.tolist() and which.walk == (log["kind"][row] == WALK)
            else:
                with pytest.raises(ValueError, match="performs nothing then"):
                    at_time(log, plan, worker, time_s)
            seen.add(int(log["kind"][row]))
    assert {WORK, WALK} <= seen and len(seen) > 3


def test_who_and_what_is_not_there_is_answered_with_the_nearest(done):
    log, plan = done
    worker, task = plan.workers[0].name, plan.tasks[0].name
    with pytest.raises(ValueError, match=f"did you mean '{worker}'"):
        performance_of(log, plan, worker + "x", task, 0)
    with pytest.raises(ValueError, match=f"did you mean '{task}'"):
        performance_of(log, plan, worker, task + "x", 0)
    done_by = plan.tasks[log["task"][np.flatnonzero((log["kind"] == WORK) & (log["worker"] == 0))[0]]].name
    with pytest.raises(ValueError, match="found no performance 999999, expected one of 0"):
        performance_of(log, plan, worker, done_by, 999_999)
