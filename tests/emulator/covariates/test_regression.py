import numpy as np
import pytest
from scipy.stats import binom

from emulator.covariates.regression import Folds, best_r2, common_share, kept, noise_p, noise_r2, p_of_noise, pls1
from tests.emulator.covariates.cases import formula_case, naive_left_out_r2, naive_pls1, people

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


@pytest.mark.parametrize("n, n_components", [(4, 1), (6, 1), (18, 4)])
def test_noise_passes_the_bar_as_often_as_it_says(n, n_components):
    """20 draws of people, 200 noise scores each: 5 % of 4,000, within a third (the bar itself is drawn)."""
    rng, below = np.random.default_rng(0), []
    for _ in range(20):
        folds = Folds.of(people(n, rng), np.arange(n))
        r2 = best_r2(folds, rng.standard_normal((n, 200)), n_components)
        below.append(p_of_noise(r2, noise_r2(folds, n_components)) < 0.05)
    assert 0.035 < np.mean(below) < 0.065


def test_the_tail_beyond_the_draws_is_that_of_noise():
    """The p of an R^2 that one noise score in 2,000 reaches, from 1,000 draws: right within a factor of 3."""
    rng = np.random.default_rng(7)
    folds = Folds.of(people(18, rng), np.arange(18))
    many = np.concatenate([best_r2(folds, rng.standard_normal((18, 1000)), 4) for _ in range(40)])
    p = p_of_noise(np.quantile(many, [1 - 1 / 2000]), noise_r2(folds, 4))[0]
    assert 1 / 6000 < p < 3 / 2000


def test_positive_r2_alone_would_keep_noise_several_times_as_often():
    rng = np.random.default_rng(1)
    folds = Folds.of(people(8, rng), np.arange(8))
    assert np.mean(best_r2(folds, rng.standard_normal((8, 500)), 2) > 0) > 0.15


@pytest.mark.parametrize("common", [1.0, 0.6, 0.0])
def test_scores_of_several_rows_a_person_are_not_taken_for_more_people(common):
    """Height, mass, age and pace of 6 people with 8 rows each: of noise with this much in common at most 8 % pass."""
    rng, passed = np.random.default_rng(2), []
    groups = np.repeat(np.arange(6), 8)
    for _ in range(20):
        folds = Folds.of(people(6, rng)[groups], groups)
        own = rng.standard_normal((6, 100))[groups]
        y = np.sqrt(common) * own + np.sqrt(1 - common) * rng.standard_normal(own.shape)
        passed.append(noise_p(folds, y, best_r2(folds, y, 1), 1) < 0.05)
    assert np.mean(passed) < 0.08


def test_the_common_share_is_the_one_put_in():
    rng, groups = np.random.default_rng(6), np.repeat(np.arange(200), [4, 6] * 100)
    own = rng.standard_normal((200, 3))[groups] * np.sqrt([0.0, 0.5, 1.0])
    y = own + rng.standard_normal(own.shape) * np.sqrt([1.0, 0.5, 0.0])
    assert np.allclose(common_share(y, groups), [0.0, 0.5, 1.0], atol=0.06)


def test_the_noise_is_always_the_same():
    folds = Folds.of(people(7, np.random.default_rng(3)), np.arange(7))
    assert noise_r2(folds, 1).tobytes() == noise_r2(folds, 1).tobytes()


def test_each_asks_the_level_score_by_score_and_fdr_counts_how_many_were_asked():
    p = np.array([0.001, 0.04, 0.012, 0.6, np.nan])
    assert kept(p, 0.95, "each").tolist() == [True, True, True, False, False]
    assert kept(p, 0.95, "fdr").tolist() == [True, False, True, False, False]


def test_families_are_corrected_each_for_itself():
    p = np.array([0.04, 0.5, 0.6, 0.7])
    assert not kept(p, 0.95, "fdr").any()
    assert kept(p, 0.95, "fdr", np.array([0, 1, 1, 1])).tolist() == [True, False, False, False]


def test_with_nothing_to_find_fdr_keeps_nothing_in_19_of_20_fits():
    rng = np.random.default_rng(4)
    any_kept = sum(kept(rng.random(60), 0.95, "fdr").any() for _ in range(400))
    assert any_kept <= binom.ppf(0.999, 400, 0.05)


GROUPS = {
    "each row a person": np.arange(14),
    "people in another order": np.random.default_rng(1).permutation(14),
    "several rows a person": np.array([0, 0, 1, 1, 1, 2, 3, 4, 4, 5, 6, 6, 7, 7]),
}


@pytest.mark.parametrize("groups", GROUPS.values(), ids=GROUPS)
def test_r2_is_that_of_fits_without_each_person(groups):
    rng = np.random.default_rng(2)
    x, y = people(14, rng), rng.standard_normal((14, 5)) + 40.0
    y[:, 0] += 2 * x[:, 0]
    found = Folds.of(x, groups).r2(y, 3)
    for a in range(4):
        for k in range(5):
            assert found[a, k] == pytest.approx(naive_left_out_r2(x, y[:, k], groups, a), abs=1e-10)


def test_no_component_explains_nothing_and_a_true_line_everything():
    x = people(10, np.random.default_rng(3))
    found = Folds.of(x, np.arange(10)).r2(x @ np.array([[1.0], [2.0], [-1.0], [0.5]]), 4)
    assert found[0, 0] == 0
    assert found[4, 0] == pytest.approx(1.0, abs=1e-9)


def test_a_covariate_that_only_one_person_has_differently_says_nothing_of_him():
    x = np.zeros((6, 1))
    x[2] = 1.0
    y = np.random.default_rng(5).standard_normal((6, 3))
    _, slopes = Folds.of(x, np.arange(6)).slopes(y, 1)
    assert np.all(slopes[1, 2] == 0)
    assert np.all(np.isfinite(slopes))
