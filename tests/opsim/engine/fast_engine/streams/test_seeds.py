from threading import Thread

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from opsim.engine.fast_engine.streams.blocks import numpys_generators
from opsim.engine.fast_engine.streams.generators import ManyBlocks
from opsim.engine.fast_engine.streams.seeds import (
    BLOCK_HASHES,
    MOST_KEPT,
    BlockHashes,
    first_states,
    states_of,
    stepped,
    word_of,
)
from opsim.streams import BLOCK, _generator, _hashed, _key

NAME = st.lists(st.text(max_size=5) | st.integers(0, 99), max_size=5)


def halves(number):
    return [number >> 64, number & (2**64 - 1)]


def numpys_state(key, block):
    state = _generator(key + _hashed(block)).bit_generator.state["state"]
    return [*halves(state["state"]), *halves(state["inc"])]


@given(st.integers(0, 2**300), st.integers(0, 2**70), NAME, st.integers(0, 2000), st.integers(1, 4))
@example(0, 0, [], 0, 1)
@example(2**128, 2**32, ["duration", "lift", "ana"], 300, 2)
@example(2**32 - 1, 2**32 - 1, ["chance"], 10**7, 3)
def test_the_generator_of_each_block_begins_where_numpys_does(seed, replication, name, first, n):
    key = _key(seed, replication, name)
    states = first_states(np.frombuffer(key, np.uint32), BLOCK_HASHES.of(first, n))
    assert states.tolist() == [numpys_state(key, block) for block in range(first, first + n)]


@pytest.mark.parametrize("seed", range(5))
def test_a_step_gives_numpys_next_word_and_state(seed):
    bits = np.random.PCG64(seed)
    state = bits.state["state"]
    high, low, *increment = map(np.uint64, [*halves(state["state"]), *halves(state["inc"])])
    for _ in range(200):
        high, low = map(np.uint64, stepped(high, low, *increment))
        assert word_of(high, low) == bits.random_raw()
        assert halves(bits.state["state"]["state"]) == [high, low]


@given(
    st.integers(0, 2**300),
    st.integers(0, 2**70),
    st.lists(st.tuples(NAME, st.integers(0, 4)), min_size=1, max_size=6),
)
def test_the_blocks_of_many_streams_begin_where_those_of_each_do(seed, replication, streams):
    keys = [np.frombuffer(_key(seed, replication, name), np.uint32) for name, _ in streams]
    n_begun = len(_key(seed, replication, ())) // 4
    names = [key[n_begun:] for key in keys]
    ends, n_blocks = np.cumsum([name.size for name in names]), np.array([n for _, n in streams])
    hashes = BLOCK_HASHES.of(0, 4)
    found = states_of(keys[0][:n_begun], np.concatenate(names), ends, n_blocks, hashes)
    assert found.tolist() == [
        state for key, n in zip(keys, n_blocks) for state in first_states(key, hashes[:n]).tolist()
    ]


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


WORDS = np.frombuffer(_key(9, 4, ("duration", "lift", "ana")), np.uint32)
ASKED = [
    ("random",),
    ("standard_exponential",),
    ("standard_normal",),
    ("standard_gamma", 3.5),
    ("standard_gamma", 1),
    ("standard_gamma", 1.0),
    ("standard_gamma", 0.4),
    ("exponential", 12.3),
    ("gamma", 2, 7.5),
    ("gamma", 0.25, 80.0),
    ("normal", 0.0, 0.3),
    ("uniform", 2.3, 9.1),
    ("triangular", 1.2, 3.4, 7.9),
    ("triangular", 0.0, 0.0, 60.0),
    ("triangular", 3.0, 8.0, 8.0),
    ("weibull", 1.4),
    ("beta", 2.0, 3.5),
    ("geometric", 0.2),
    ("integers", 7),
    ("integers", 3, 9),
]


def same(ours, theirs, *asked, **more):
    name, *said = asked
    wanted = np.concatenate([getattr(rng, name)(*said, size=BLOCK, **more) for rng in theirs])
    found = getattr(ours, name)(*said, size=len(theirs) * BLOCK, **more)
    return found.dtype == wanted.dtype and np.array_equal(found, wanted)


@pytest.mark.parametrize("n", [1, 2, 7, 40])
@pytest.mark.parametrize("asked", ASKED, ids=str)
def test_every_method_gives_what_the_generators_of_the_blocks_give(asked, n):
    assert same(ManyBlocks(WORDS, 5, n), numpys_generators(WORDS, 5, n), *asked)


def test_whole_numbers_up_to_and_with_the_highest():
    assert same(ManyBlocks(WORDS, 0, 3), numpys_generators(WORDS, 0, 3), "integers", 1, 6, endpoint=True)


@pytest.mark.parametrize("seed", range(6))
def test_methods_in_any_order_go_on_where_the_last_one_ended(seed):
    """Compiled ones before and after such that need real generators."""
    order = np.random.default_rng(seed).permutation(len(ASKED))
    ours, theirs = ManyBlocks(WORDS, 2, 3), numpys_generators(WORDS, 2, 3)
    assert all(same(ours, theirs, *ASKED[i]) for i in order)


@pytest.mark.parametrize("asked", ASKED, ids=str)
def test_another_number_than_64_a_block_is_refused(asked):
    name, *said = asked
    with pytest.raises(ValueError, match="2 blocks give 128 numbers at once, found 64"):
        getattr(ManyBlocks(WORDS, 0, 2), name)(*said, size=BLOCK)
