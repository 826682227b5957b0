from threading import Thread

import numpy as np
import pytest

from opsim.engine.fast_engine.streams.seeds import MOST_KEPT, BlockHashes
from opsim.streams import _hashed


@pytest.mark.parametrize(("first", "n"), [(0, 1), (3, 5), (250, 12), (255, 1), (256, 1), (5000, 3), (7, 0)])
def test_rows_are_the_hashes_of_the_block_numbers(first, n):
    hashes = BlockHashes()
    for _ in range(2):
        assert hashes.of(first, n).tobytes() == b"".join(map(_hashed, range(first, first + n)))


@pytest.mark.parametrize("first", [5000, MOST_KEPT - 1, 10**12])
def test_far_blocks_are_hashed_without_a_table_up_to_them(first):
    hashes = BlockHashes()
    assert hashes.of(first, 2).tobytes() == _hashed(first) + _hashed(first + 1)
    assert len(hashes._rows) == 0


def test_a_stream_that_goes_on_meets_a_table_that_grows():
    hashes = BlockHashes()
    for first in range(0, 1100, 4):
        hashes.of(first, 4)
    assert len(hashes._rows) == 2048


def test_rows_that_were_given_out_stay_as_they_were_while_the_table_grows():
    hashes = BlockHashes()
    early = hashes.of(0, 4)
    before = early.copy()
    hashes.of(250, 300)
    assert len(hashes._rows) == 1024 and np.array_equal(early, before) and np.array_equal(hashes.of(0, 4), before)


def test_threads_that_grow_it_at_once_all_find_their_rows():
    hashes, wrong = BlockHashes(), []

    def ask(start):
        for first in range(start, 3000, 7):
            if hashes.of(first, 1).tobytes() != _hashed(first):
                wrong.append(first)

    threads = [Thread(target=ask, args=(start,)) for start in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong and len(hashes._rows) == 4096
