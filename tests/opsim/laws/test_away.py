"""A job that waits for one worker: who is at work elsewhere, or never was at the job, is found."""

from plans import plan

from opsim.laws.capacity import away
from opsim.laws.jobs import Stays
from opsim.log import AWAY, BREAK, HELD, WAIT, WALK
from tests.opsim.kpi.made_logs import made, row, work
from tests.opsim.laws.test_progress import FLOOR

BEGUN = work(0, 4, 0, worker=0, task=0, k=0, progress=(0, 0.4))
WAITS = row(HELD, 4, 50, station=0, job=0, cause=AWAY)


def found(*rows):
    p = plan(FLOOR)
    log = made(rows, p)
    return list(away(log, p, Stays(log)))


def test_who_rests_and_comes_back_is_waited_for_with_right():
    rest = work(50, 56, 0, worker=0, task=0, k=0, progress=(0.4, 1))
    assert found(BEGUN, WAITS, row(BREAK, 4, 49, worker=0), rest) == []


def test_who_works_on_another_job_meanwhile_is_found():
    assert "waits for ana, who is at work elsewhere at 20 s" in found(BEGUN, WAITS, work(20, 30, 1, 1, worker=0))[0]
    assert found(BEGUN, WAITS, work(20, 30, 1, 1, worker=1)) == []


def test_who_is_back_and_idles_while_the_job_waits_for_him_is_found():
    there = row(WAIT, 20, 50, worker=0)
    assert (
        "waits for ana, who is there, and idle, at 20 s" in found(BEGUN, WAITS, row(BREAK, 4, 20, worker=0), there)[0]
    )
    on_the_way = row(WALK, 20, 50, worker=0, station=0, places=(1, 0))
    assert found(BEGUN, WAITS, row(BREAK, 4, 20, worker=0), on_the_way) == []


def test_a_job_that_nobody_has_begun_waits_for_nobody():
    assert "none has left work on it" in found(WAITS)[0]
    assert "none has left work on it" in found(work(0, 4, 0, worker=0, k=0), WAITS)[0]
