import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.kpi.exposure import gini

SHARES = st.lists(st.floats(0, 1e6), min_size=1, max_size=30)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([5, 5, 5], 0),
        ([0, 0, 9], 2 / 3),  # one has all: 1 - 1/3
        ([1, 3], 0.25),  # |1 - 3| twice over 4 pairs is 1; over twice the mean: 1 / (2 * 2)
        ([0, 0, 0], 0),
        ([7], 0),
        ([4, np.nan, 4], 0),
    ],
)
def test_known_answers(values, expected):
    assert gini(np.array(values, float)) == pytest.approx(expected)


def test_of_nobody_it_is_not_known_and_less_than_nothing_is_refused():
    assert np.isnan(gini(np.array([]))) and np.isnan(gini(np.array([np.nan])))
    with pytest.raises(ValueError, match="less than nothing, found -1"):
        gini(np.array([2.0, -1.0]))


@given(SHARES, st.floats(0.1, 10))
def test_it_is_the_mean_difference_of_all_pairs_and_knows_no_unit(values, factor):
    have = np.array(values)
    found = gini(have)
    assert 0 <= found <= 1 - 1 / have.size + 1e-9
    if have.sum() > 1e-3:
        pairs = np.abs(have[:, None] - have).mean()
        assert found == pytest.approx(pairs / (2 * have.mean()), abs=1e-9)
        assert gini(have * factor) == pytest.approx(found, abs=1e-9)
