import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from opsim.threads import one_blas_thread


@pytest.fixture(autouse=True)
def two_threads():
    """As on a machine of two cores, however many there are here."""
    with threadpool_limits(limits=2, user_api="blas"):
        yield


def threads():
    np.ones((2, 2)) @ np.ones((2, 2))
    return {found["num_threads"] for found in threadpool_info() if found["user_api"] == "blas"}


def test_blas_has_one_thread_inside_and_what_it_had_outside():
    assert threads() == {2}
    with one_blas_thread():
        with one_blas_thread():
            assert threads() == {1}
        assert threads() == {1}
    assert threads() == {2}


def test_a_failure_inside_gives_the_threads_back():
    with pytest.raises(KeyError), one_blas_thread():
        raise KeyError("whatever")
    assert threads() == {2}
    with one_blas_thread():
        assert threads() == {1}
