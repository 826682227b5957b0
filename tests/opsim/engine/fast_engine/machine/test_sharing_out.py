"""Work shared out: each job done once, by whoever; what another process leaves undone is done here."""

import sys

from opsim.engine.fast_engine.machine import compiling
from opsim.engine.fast_engine.machine.compiling import Job, Work, helped

ANSWERS = "import sys; print(flush=True); [print(flush=True) for _ in sys.stdin]"
ENDS = "import sys; print(flush=True); sys.stdin.readline()"


def jobs(n, done):
    return [Job(f"job {i}", lambda i=i: done.append(i)) for i in range(n)]


def all_done(work):
    while (job := work.first()) is not None:
        job.here()


def test_this_process_takes_from_the_beginning_and_others_from_the_end():
    work = Work(jobs(3, []))
    assert [work.first().name, work.last().name] == ["job 0", "job 2"]
    assert work.n_open == 2


def test_what_has_no_name_is_given_to_nobody():
    assert Work([Job("", list)]).last() is None


def test_what_went_wrong_elsewhere_is_done_here():
    done = []
    work = Work(jobs(2, done))
    work.done(work.last(), well=False)
    all_done(work)
    assert done == [0, 1]
    assert work.n_open == 0


def test_what_another_process_never_finishes_is_not_waited_for_for_ever(monkeypatch):
    monkeypatch.setattr(compiling, "PATIENCE_S", 0.01)
    work = Work(jobs(1, []))
    work.last()
    assert work.first() is None


def test_a_process_that_answers_does_the_rest(monkeypatch):
    monkeypatch.setattr(compiling, "n_helpers", lambda: 1)
    work = Work(jobs(5, []))
    with helped(work, ["-c", ANSWERS]):
        with work._changed:
            assert work._changed.wait_for(lambda: not work.n_open, 60)
        assert work.first() is None


def test_of_a_process_that_ends_nothing_is_lost(monkeypatch):
    monkeypatch.setattr(compiling, "n_helpers", lambda: 1)
    done = []
    work = Work(jobs(5, done))
    with helped(work, ["-c", ENDS]):
        all_done(work)
    assert sorted(done) == [0, 1, 2, 3, 4]


def test_no_process_is_left(monkeypatch):
    begun, really = [], compiling._begun
    monkeypatch.setattr(compiling, "n_helpers", lambda: 2)
    monkeypatch.setattr(compiling, "_begun", lambda command: begun.append(really(command)) or begun[-1])
    try:
        with helped(Work([]), ["-c", "input()"]):
            raise KeyboardInterrupt
    except KeyboardInterrupt:
        pass
    assert len(begun) == 2 and all(one.returncode is not None for one in begun)
    assert sys.executable == begun[0].args[0]


def test_where_no_process_can_be_begun_all_is_done_here(monkeypatch):
    monkeypatch.setattr(compiling, "n_helpers", lambda: 1)
    for executable in ("", "/no/such/python"):
        monkeypatch.setattr(sys, "executable", executable)
        done = []
        work = Work(jobs(3, done))
        with helped(work, ["-c", ANSWERS]):
            all_done(work)
        assert done == [0, 1, 2]
