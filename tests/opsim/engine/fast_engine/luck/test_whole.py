"""Numbers that are kept whole: all of them, in their order, without copying all at each step."""

import numpy as np

from opsim.engine.fast_engine.streams.of_plan import Whole

GROWTHS, AT_ONCE = 300, 64


def test_all_numbers_are_there_in_their_order():
    whole = Whole()
    for i in range(GROWTHS):
        whole.add(np.arange(i * AT_ONCE, (i + 1) * AT_ONCE, dtype=float))
        assert whole.n == (i + 1) * AT_ONCE
        assert np.array_equal(whole.numbers, np.arange(whole.n))


def test_all_that_was_ever_given_takes_little_more_than_the_last():
    whole, given = Whole(), {}
    for _ in range(GROWTHS):
        whole.add(np.ones(AT_ONCE))
        given[id(whole.numbers.base)] = whole.numbers.base
    assert sum(room.nbytes for room in given.values()) < 4 * whole.numbers.nbytes


def test_what_was_given_before_stays_as_it_was():
    whole = Whole()
    whole.add(np.zeros(AT_ONCE))
    before = whole.numbers
    for _ in range(GROWTHS):
        whole.add(np.ones(AT_ONCE))
    assert not before.any()
