from math import expm1, log, log1p, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.task_model import log_variance, within_cv

CVS, SHARES = st.floats(1e-3, 10), st.floats(0, 1)


@given(CVS, SHARES)
def test_between_and_within_give_back_the_cv(cv, share):
    between_cv2 = expm1(share * log_variance(cv))
    assert (1 + between_cv2) * (1 + within_cv(cv, share) ** 2) == pytest.approx(1 + cv**2, rel=1e-12)


@given(CVS, SHARES)
def test_for_lognormal_times_the_share_is_that_of_the_variance_of_log_time(cv, share):
    assert log1p(within_cv(cv, share) ** 2) == pytest.approx((1 - share) * log_variance(cv), rel=1e-9, abs=1e-15)


def test_known_values():
    assert within_cv(0.3, 0.0) == 0.3
    assert within_cv(0.3, 1.0) == 0.0
    assert log_variance(1.0) == pytest.approx(log(2))
    assert within_cv(1.0, 0.5) == pytest.approx(sqrt(sqrt(2) - 1))
