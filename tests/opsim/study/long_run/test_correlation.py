import numpy as np
import pytest

from opsim.study.long_run import correlogram, lag_one, von_neumann


def naive_correlogram(series, most):
    mean = sum(series) / len(series)
    squares = sum((x - mean) ** 2 for x in series)
    return [
        sum((series[i] - mean) * (series[i + k] - mean) for i in range(len(series) - k)) / squares
        for k in range(most + 1)
    ]


def test_a_correlogram_by_hand():
    """1, 2, 3, 4: deviations -1.5, -0.5, 0.5, 1.5; products of neighbours 0.75, -0.25, 0.75 over squares of 5."""
    assert correlogram([1, 2, 3, 4], 2) == pytest.approx([1, 0.25, -0.3])


def test_it_is_the_naive_correlogram():
    series = np.random.default_rng(1).normal(size=50).cumsum()
    assert correlogram(series, 12) == pytest.approx(naive_correlogram(series.tolist(), 12))


def test_a_constant_has_no_correlation_but_with_itself():
    assert correlogram(np.full(9, 0.1), 3).tolist() == [1, 0, 0, 0]
    assert lag_one(np.full(9, 0.1)) == 0
    assert von_neumann(np.full(9, 0.1)) == (2.0, 1.0)


def test_replications_are_pooled_and_never_joined():
    """Two replications that are constant, one high, one low: neighbours within each are alike."""
    assert correlogram([[1.0] * 8, [-1.0] * 8], 1)[1] == pytest.approx(7 / 8)


def test_the_jackknife_takes_the_bias_of_short_series_away():
    """AR(1) with 0.5, 4,000 series of 60 (standard error 0.002): the plain estimate lies 0.05 too low."""
    rng = np.random.default_rng(2)
    state, values = rng.normal(0, np.sqrt(4 / 3), 4000), []
    for _ in range(60):
        values.append(state)
        state = 0.5 * state + rng.normal(size=4000)
    series = np.array(values).T
    plain = np.mean([correlogram(one, 1)[1] for one in series[:1500]])
    assert plain < 0.47 and np.mean([lag_one(one) for one in series[:1500]]) == pytest.approx(0.5, abs=0.015)


def test_von_neumanns_ratio_by_hand_and_its_size():
    """1, 2, 3, 4: squared steps 3 over squares 5; 2 on average where neighbours are independent."""
    assert von_neumann([1, 2, 3, 4])[0] == pytest.approx(0.6)
    rng = np.random.default_rng(3)
    found = np.array([von_neumann(one) for one in rng.normal(size=(2000, 20))])
    assert found[:, 0].mean() == pytest.approx(2.0, abs=0.03)
    assert 0.03 <= np.mean(found[:, 1] <= 0.05) <= 0.07


def test_values_that_are_not_finite_are_refused():
    with pytest.raises(ValueError, match="not finite"):
        correlogram([1.0, np.nan], 1)
