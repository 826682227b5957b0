"""Handfuls of items: as large as is soon done, and nothing of them is lost."""

from itertools import islice

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.study import handfuls
from opsim.study.handfuls import AT_ONCE_S, MOST_S, Done, Left, do, next_size


def after(n, took_s):
    return next_size(Done([None] * n, [], took_s))


def test_a_handful_grows_to_what_is_soon_done_and_shrinks_to_one_item():
    assert [after(1, 0.0), after(4, AT_ONCE_S / 100), after(4, AT_ONCE_S / 2)] == [2, 8, 8]
    assert [after(8, AT_ONCE_S * 2), after(8, AT_ONCE_S * 100), after(1, AT_ONCE_S * 2)] == [4, 1, 1]


def test_what_there_is_no_time_for_is_given_back(monkeypatch):
    now_s = [0.0]
    monkeypatch.setattr(handfuls, "perf_counter", lambda: now_s[0])

    def work(item_s):
        now_s[0] += item_s
        return -item_s

    assert do(work, [MOST_S / 4] * 3) == ([-MOST_S / 4] * 3, [], 0.75 * MOST_S)
    assert do(work, [0.0, 60.0, 1.0, 2.0])[:2] == ([0.0, -60.0], [1.0, 2.0])
    assert do(work, [60.0])[:2] == ([-60.0], [])


def test_what_was_done_before_an_error_is_not_lost_and_the_error_comes_with_the_next_handful():
    done = do(lambda item: 1 // item, [1, 1, 0, 1])
    assert done[:2] == ([1, 1], [0, 1])
    with pytest.raises(ZeroDivisionError):
        do(lambda item: 1 // item, done.undone)


@given(st.lists(st.tuples(st.integers(1, 5), st.integers(0, 4))))
def test_each_item_is_handed_out_until_it_is_not_given_back(steps):
    left, kept = Left(range(20)), []
    for n, n_back in steps:
        some = list(islice(left, n))
        kept += some[: max(0, len(some) - n_back)]
        left.give_back(some[max(0, len(some) - n_back) :])
    assert sorted([*kept, *left]) == list(range(20))
