import threading

import pytest

from opsim.study.threads import threaded


def test_every_item_is_done_once_and_what_is_prepared_is_shared():
    made = []

    def prepare():
        made.append(1)
        return lambda item: item**2

    assert sorted(threaded(prepare, range(50), 3)) == [item**2 for item in range(50)] and made == [1]


def test_several_are_in_hand_at_once():
    together = threading.Barrier(2, timeout=10)
    assert list(threaded(lambda: lambda item: bool(together.wait() + 1), range(4), 2)) == [True] * 4


def test_what_the_work_raises_is_raised_and_nothing_more_is_begun():
    begun = []

    def work(item):
        begun.append(item)
        if item == 1:
            raise ZeroDivisionError
        return item

    with pytest.raises(ZeroDivisionError):
        list(threaded(lambda: work, range(1000), 2))
    assert len(begun) < 1000 and threading.active_count() < 10


def test_it_is_over_when_who_asks_has_enough():
    before = threading.active_count()
    results = threaded(lambda: lambda item: item, range(1000), 2)
    next(results)
    results.close()
    assert threading.active_count() == before


def test_what_is_best_done_meanwhile_is_done_once():
    done = []
    assert len(list(threaded(lambda: lambda item: item, range(10), 2, lambda: done.append(1)))) == 10 and done == [1]
