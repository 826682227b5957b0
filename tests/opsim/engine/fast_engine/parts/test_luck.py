"""Where a stream is looked for is the same place for Python, which makes the table, as for compiled code."""

import numba
from hypothesis import given
from hypothesis import strategies as st

from opsim.engine.fast_engine.random_numbers import place_of

compiled = numba.njit("int64(int64, int64)")(place_of)


@given(st.integers(1, 2**63 - 1), st.integers(1, 20))
def test_python_and_compiled_code_look_at_one_place(stream, bits):
    mask = (1 << bits) - 1
    assert compiled(stream, mask) == place_of(stream, mask) <= mask
