import numba
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from opsim.engine.fast_engine.streams.seeds import product_high

WORD = st.integers(0, 2**64 - 1)


@numba.njit
def upper_half(one, other):
    return product_high(one, other)


@given(WORD, WORD)
def test_the_upper_half_is_that_of_whole_numbers_of_any_length(one, other):
    assert upper_half(np.uint64(one), np.uint64(other)) == one * other >> 64
