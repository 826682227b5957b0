"""Memory that is lent: it comes back, within bounds, also in the middle of taking some."""

import gc

import numpy as np
import pytest

from opsim.engine.fast_engine import log_rows
from opsim.engine.fast_engine.log_rows import MOST_KEPT, MOST_WASTE, lent


@pytest.fixture(autouse=True)
def nothing_kept(monkeypatch):
    """NOTE: logs that tests before have left in cycles would come back in the middle, and push out what is kept."""
    gc.collect()
    gc.disable()
    monkeypatch.setattr(log_rows, "_kept", type(log_rows._kept)())
    yield
    gc.enable()


def place_of(memory):
    return memory.ctypes.data


def kept_bytes():
    return [memory.nbytes for memory in log_rows._kept]


def test_what_came_back_is_lent_again_and_what_is_in_use_is_not():
    first, second = lent(1 << 16), lent(1 << 16)
    assert place_of(first) != place_of(second)
    at, part = place_of(first), first[10:20]
    del first
    assert place_of(lent(1 << 16)) != at, "a part of it is in use"
    del part
    assert at in {place_of(memory) for memory in log_rows._kept}


def test_the_smallest_that_is_large_enough_is_lent():
    for n_bytes in (3000, 2000, 1000):
        log_rows._keep(np.empty(n_bytes, np.uint8))
    assert lent(1500).nbytes == 2000


def test_a_small_log_does_not_hold_large_memory():
    log_rows._keep(np.empty(1000 * MOST_WASTE, np.uint8))
    assert lent(999).nbytes == 999
    assert lent(1000).nbytes == 1000 * MOST_WASTE


def test_no_more_is_kept_than_a_few_and_the_first_to_go_is_the_oldest():
    for n_bytes in range(1, 10):
        log_rows._keep(np.empty(n_bytes, np.uint8))
    assert kept_bytes() == [9, 8, 7, 6][:MOST_KEPT]


def test_all_that_is_kept_is_bounded_and_what_is_larger_is_let_go(monkeypatch):
    monkeypatch.setattr(log_rows, "MOST_BYTES", 1000)
    for n_bytes in (400, 500, 1001, 300):
        log_rows._keep(np.empty(n_bytes, np.uint8))
    assert kept_bytes() == [300, 500]


def test_memory_that_comes_back_while_some_is_taken_is_not_lent_twice(monkeypatch):
    """Python may collect what is unused at any moment: here, as soon as it is looked at what there is."""
    for n_bytes in (100, 200, 300):
        log_rows._keep(np.empty(n_bytes, np.uint8))

    class Collecting(np.ndarray):
        @property
        def nbytes(self):
            if late:
                log_rows._keep(late.pop())
            return self.size

    late = [np.empty(5, np.uint8), np.empty(50, np.uint8)]
    log_rows._kept.appendleft(np.empty(250, np.uint8).view(Collecting))
    taken = log_rows._taken(90)
    kept = list(log_rows._kept)
    assert taken.size == 100 and not late
    assert len({place_of(one) for one in (taken, *kept)}) == 1 + len(kept)
