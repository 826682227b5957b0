from dataclasses import replace

import numpy as np
import pytest
import simpy

from opsim import Worker, WorkerLog, read_events, write_events
from opsim.external_log import CHECKS, audit_work
from opsim.laws import BrokenLog
from opsim.log import COLUMNS, WAIT, WORK
from opsim.tasks import Fixed


def shift(until=None):
    """w10 folds, stops at 4 s and goes on at 9 s; w2 comes at 5 s and tapes. Returns (env, log)."""
    env, log = simpy.Environment(), WorkerLog()
    tasks = {"fold": Fixed(10.0), "tape": Fixed(3.0)}
    w10 = Worker(env, "w10", tasks, log=log)

    def folding():
        doing = w10.perform("fold")
        yield env.timeout(4.0)
        doing.interrupt()
        piece = yield doing
        yield env.timeout(5.0)
        yield w10.resume(piece)

    def taping():
        yield env.timeout(5.0)
        w2 = Worker(env, "w2", tasks, log=log)
        yield w2.perform("tape")
        yield w2.perform("tape")

    env.process(folding())
    env.process(taping())
    env.run(until=until)
    return env, log


def rows(log, kind):
    found = log.of(kind)
    return [
        (log.names["worker"][worker], float(start_s), float(end_s))
        for worker, start_s, end_s in zip(found["worker"], found["start_s"], found["end_s"])
    ]


def test_rows_say_who_did_what_from_when_to_when():
    log = shift(until=20.0)[1].close()
    assert rows(log, WORK) == [("w10", 0, 4), ("w2", 5, 8), ("w2", 8, 11), ("w10", 9, 15)]
    assert rows(log, WAIT) == [("w10", 4, 9), ("w2", 11, 20), ("w10", 15, 20)]
    work = log.of(WORK)
    assert [log.names["task"][task] for task in work["task"]] == ["fold", "tape", "tape", "fold"]
    assert work["k"].tolist() == [0, 0, 1, 0] and work["performance_id"].tolist() == [0, 1, 2, 0]
    assert work["progress_from"].tolist() == [0, 0, 0, 0.4] and work["progress_to"].tolist() == [0.4, 1, 1, 1]
    assert log.horizon_s == 20.0


def test_names_are_in_natural_order():
    log = shift()[1].close()
    assert log.names["worker"] == ("w2", "w10") and log.names["task"] == ("fold", "tape")


def test_what_is_under_way_is_closed_with_its_progress_and_the_simulation_may_go_on():
    env, log = shift(until=10.0)
    early = log.close()
    assert rows(early, WORK)[-2:] == [("w2", 8, 10), ("w10", 9, 10)]
    assert early.of(WORK)["progress_to"][-2:].tolist() == pytest.approx([2 / 3, 0.5])
    env.run(until=20.0)
    late = log.close()
    assert all(np.array_equal(late[name], shift(until=20.0)[1].close()[name], equal_nan=True) for name in COLUMNS)


def test_an_events_file_reads_back_equal(tmp_path):
    log = shift(until=20.0)[1].close()
    write_events(log, tmp_path / "events.parquet")
    back = read_events(tmp_path / "events.parquet")
    assert back.names == log.names and (back.horizon_s, back.replication) == (20.0, 0)
    assert all(np.array_equal(back[name], log[name], equal_nan=True) for name in COLUMNS)


def test_a_log_of_nobody_and_one_of_no_time_are_empty(tmp_path):
    env, log = simpy.Environment(), WorkerLog()
    assert len(log.close()) == 0
    Worker(env, "ana", {"fold": Fixed(1.0)}, log=log)
    empty = log.close()
    assert len(empty) == 0 and empty.names["worker"] == ("ana",)
    write_events(empty, tmp_path / "empty.parquet")
    assert len(read_events(tmp_path / "empty.parquet")) == 0


def test_two_workers_of_separate_logs_have_a_log_each():
    env = simpy.Environment()
    ana, ben = (Worker(env, name, {"fold": Fixed(1.0)}) for name in ("ana", "ben"))
    env.run(ana.perform("fold"))
    assert len(ana.log.close()) == 1 and ben.log.close().names["worker"] == ("ben",)


@pytest.mark.parametrize(
    ("column", "row", "value", "said"),
    [
        ("end_s", 0, 3.0, "worker w10: gap between 3 s and 4 s"),
        ("end_s", 0, 5.0, "worker w10: overlap between 5 s and 4 s"),
        ("end_s", -1, 19.0, "gap between 19 s and 20 s"),
        ("progress_from", 4, 0.3, "performance 0: a piece goes from 30% to 100% where 40% was done"),
        ("progress_to", 0, 1.5, "to 150%"),
    ],
)
def test_a_log_that_contradicts_itself_is_refused(column, row, value, said):
    log = shift(until=20.0)[1].close()
    assert audit_work(log) == CHECKS
    changed = log[column].copy()
    changed[row] = value
    with pytest.raises(BrokenLog, match=said):
        audit_work(replace(log, columns={**log.columns, column: changed}))
