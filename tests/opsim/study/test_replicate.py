"""When more than one process is used. The rows are the same either way: tests/opsim/study/test_run.py."""

import pytest

from opsim.study import replication as replicating


@pytest.mark.parametrize(
    ("took_s", "at_home"),
    [
        ((0.1,), 20),
        ((1.5, 0.1), 20),
        ((1.5, 1.4), 2),
        ((9.0,), 1),
    ],
    ids=["quick", "only the first is slow: it loads", "all are slow", "so slow that no second is asked"],
)
def test_processes_are_started_where_the_work_left_is_worth_it(took_s, at_home, monkeypatch):
    clock, alone, pooled = [0.0], [], []
    pace = iter([*took_s, *[took_s[-1]] * 20])

    def run(replication):
        alone.append(replication)
        clock[0] += next(pace)
        return replication

    monkeypatch.setattr(replicating.time, "perf_counter", lambda: clock[0])
    monkeypatch.setattr(replicating, "cores", lambda: 2)
    monkeypatch.setattr(replicating, "pays", lambda seconds: seconds > 4)
    monkeypatch.setattr(replicating, "pooled", lambda runner, left, processes, meanwhile: pooled.extend(left) or left)
    assert list(replicating._results(lambda: run, range(20), None)) == list(range(20))
    assert alone == list(range(at_home)) and pooled == list(range(at_home, 20))


@pytest.mark.parametrize("processes", [1, 2])
def test_a_number_of_processes_that_is_asked_for_is_taken(processes, monkeypatch):
    used = []
    monkeypatch.setattr(replicating, "pooled", lambda runner, left, n, meanwhile: used.append(n) or left)
    assert list(replicating._results(lambda: lambda replication: replication, range(3), processes)) == [0, 1, 2]
    assert used == ([2] if processes == 2 else [])
