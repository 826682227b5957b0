import numpy as np
import pytest
import simpy

from opsim import Worker, WorkerLog
from opsim.ergonomics.shift.external import natural, only, rows_of, whole_days
from opsim.log import COLUMNS, OFF, WAIT, WORK
from opsim.tasks import Fixed


def shift(until=60.0):
    """w10 folds from 0 to 10, is broken off at 4 and goes on at 9; w2 tapes from 20 to 23. (log, pieces)"""
    env, log, done = simpy.Environment(), WorkerLog(), []
    tasks = {"fold": Fixed(10.0), "tape": Fixed(3.0)}
    w10, w2 = (Worker(env, name, tasks, log=log) for name in ("w10", "w2"))

    def folding():
        doing = w10.perform("fold")
        yield env.timeout(4.0)
        doing.interrupt()
        piece = yield doing
        yield env.timeout(5.0)
        done.extend([piece, (yield w10.resume(piece))])

    def taping():
        yield env.timeout(20.0)
        done.append((yield w2.perform("tape")))

    env.process(folding())
    env.process(taping())
    env.run(until=until)
    return log.close(), done


def test_rows_of_pieces_are_the_rows_of_work_of_the_log():
    log, done = shift()
    own, work = rows_of(done[::-1], 0), log.of(WORK)
    assert len(own) == 3 and own.horizon_s == 23.0
    for column in COLUMNS:
        assert np.array_equal(own[column], work[column], equal_nan=True), column


def test_a_piece_that_took_no_time_is_no_row():
    _, done = shift()
    assert len(rows_of([done[0].until(0.0)], 0)) == 0


def test_everybody_has_a_row_at_every_time_and_is_off_where_he_had_none():
    log, done = shift()
    days = whole_days(rows_of(done, 0), ["fold", "tape", "cut"], 2.0)
    assert days.names["task"] == ("cut", "fold", "tape")
    assert [days.names["task"][task] for task in days.of(WORK)["task"]] == ["fold", "fold", "tape"]
    off = days.of(OFF)
    found = sorted(zip(off["worker"].tolist(), off["start_s"].tolist(), off["end_s"].tolist()))
    w2, w10 = 0, 1
    assert found == [(w2, 2.0, 20.0), (w10, 4.0, 9.0), (w10, 15.0, 23.0)]
    assert len(whole_days(log, [], 0.0).of(OFF)) == 0  # a log says when he waited


def test_who_does_two_things_at_once_is_refused():
    _, done = shift()
    with pytest.raises(
        ValueError, match="worker w10: something else begins at 0 s, while the piece before lasts until 4 s"
    ):
        whole_days(rows_of([done[0], done[0]], 0), [], 0.0)


def test_only_some_workers_are_left_with_rows_by_the_same_numbers():
    log, _ = shift()
    mine = only(log, [1])
    assert set(mine["kind"][mine["worker"] == 0].tolist()) == {OFF}
    assert set(mine["kind"][mine["worker"] == 1].tolist()) == {WORK, WAIT}
    assert np.array_equal(mine["start_s"], log["start_s"]) and natural(["w10", "w2", "w2"]) == ("w2", "w10")
