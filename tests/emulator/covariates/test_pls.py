import numpy as np
import pytest

from emulator.covariates.regression import pls1
from tests.emulator.covariates.cases import formula_case, naive_pls1, people

SKLEARN = {
    (0, 1): ([-0.002941419238225, -0.218695640310265, 0.095916688447794, -0.120787753494927], 0.4256495153695189),
    (0, 2): ([0.278256229879008, -0.269434190353576, -0.073522436969623, -0.043455624628895], 0.34453808310165135),
    (0, 3): ([0.303693184147049, -0.27451697166373, -0.009958192989759, -0.015231771823014], 0.17949967957999635),
    (0, 4): ([0.306434936083866, -0.274325257599737, -0.008642985547383, -0.016067499781658], 0.17631659299636399),
    (1, 1): ([0.020200631800801, 0.050124362321454, 0.770835019977858, 0.063717174983551], -1.1554118458364009),
    (1, 2): ([0.02244859205511, 0.060003521451504, 0.760340589205705, 0.095047183229833], -1.2371511749715423),
    (1, 3): ([0.027048477293499, 0.056231352129221, 0.762095304485401, 0.099778271286464], -1.2452148817788804),
    (1, 4): ([0.032385194005164, 0.05606041763848, 0.762075451991293, 0.09999067333335], -1.2504783576071745),
}
"""(score, components): slopes and intercept of scikit-learn 1.9.1, PLSRegression(scale=True) of one score at a time."""


@pytest.mark.parametrize("score, n_components", SKLEARN)
def test_slopes_and_intercepts_are_those_of_scikit_learn(score, n_components):
    intercepts, slopes = pls1(*formula_case(), 4)
    expected, at_zero = SKLEARN[score, n_components]
    assert np.allclose(slopes[n_components, :, score], expected, rtol=0, atol=2e-14)
    assert intercepts[n_components, score] == pytest.approx(at_zero, abs=2e-14)


def test_no_component_is_the_mean():
    x, y = formula_case()
    intercepts, slopes = pls1(x, y, 2)
    assert np.allclose(intercepts[0], y.mean(0))
    assert np.all(slopes[0] == 0)


def test_as_many_components_as_covariates_are_least_squares():
    x, y = formula_case()
    intercepts, slopes = pls1(x, y, 4)
    best = np.linalg.lstsq(np.column_stack([np.ones(len(x)), x]), y, rcond=None)[0]
    assert np.allclose(np.concatenate([intercepts[4][None], slopes[4]]), best, atol=1e-12)


def test_it_is_the_naive_nipals():
    rng = np.random.default_rng(4)
    x, y = people(15, rng), rng.standard_normal((15, 6))
    intercepts, slopes = pls1(x, y, 3)
    for a in range(4):
        for k in range(6):
            intercept, slope = naive_pls1(x, y[:, k], a)
            assert np.allclose(slopes[a, :, k], slope, atol=1e-12)
            assert np.isclose(intercepts[a, k], intercept, atol=1e-12)


def test_units_of_a_covariate_change_no_forecast():
    x, y = formula_case()
    scale = np.array([1000.0, 0.01, 3.0, 1.0])
    one, other = pls1(x, y, 2), pls1(x * scale + 7.0, y, 2)
    assert np.allclose(one[0][:, None] + x @ one[1], other[0][:, None] + (x * scale + 7.0) @ other[1])


def test_more_components_than_there_is_to_say_change_nothing():
    x = np.column_stack([np.arange(6.0), 2 * np.arange(6.0)])
    slopes = pls1(x, np.arange(6.0)[:, None] ** 2, 2)[1]
    assert np.allclose(slopes[1], slopes[2])
    assert np.all(np.isfinite(slopes))


def test_a_covariate_that_does_not_vary_has_no_slope():
    x, y = formula_case()
    x[:, 1] = 1.7
    slopes = pls1(x, y, 3)[1]
    assert np.all(slopes[:, 1] == 0)
    assert np.all(np.isfinite(slopes))


def test_one_row_is_refused():
    with pytest.raises(ValueError, match="found 1 rows, expected 2 or more"):
        pls1(np.ones((1, 2)), np.ones((1, 1)), 1)
