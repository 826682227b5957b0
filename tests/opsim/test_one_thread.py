import numpy as np
import pytest
from threadpoolctl import threadpool_info

from opsim.one_thread import one_blas_thread


def threads():
    np.ones((2, 2)) @ np.ones((2, 2))
    return {found["num_threads"] for found in threadpool_info() if found["user_api"] == "blas"}


def test_blas_has_one_thread_inside_and_what_it_had_outside():
    before = threads()
    with one_blas_thread():
        with one_blas_thread():
            assert threads() == {1}
        assert threads() == {1}
    assert threads() == before


def test_a_failure_inside_gives_the_threads_back():
    before = threads()
    with pytest.raises(KeyError), one_blas_thread():
        raise KeyError("whatever")
    assert threads() == before
    with one_blas_thread():
        assert threads() == {1}
