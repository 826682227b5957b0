import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from opsim.engine.fast_engine.streams.seeds import BLOCK_HASHES, first_states, states_of, stepped, word_of
from opsim.streams import _generator, _hashed, _key

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
