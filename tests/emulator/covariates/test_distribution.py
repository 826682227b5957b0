import numpy as np
from scipy.stats import f_oneway

from emulator.covariates.distribution import (
    CovariateGaussian,
    f_test,
    left_out_effects,
    level_effects,
    levels_of,
    members,
)
from tests.emulator.covariates.cases import people


def test_an_unknown_covariate_takes_its_regression_on_the_known():
    model = CovariateGaussian(np.array([1.0, 2.0]), np.array([[4.0, 1.0], [1.0, 9.0]]))
    assert np.allclose(
        model.filled(np.array([[3.0, np.nan], [np.nan, np.nan], [0.5, 0.5]])), [[3, 2.5], [1, 2], [0.5, 0.5]]
    )


def test_many_people_give_back_mean_and_covariance():
    rows = people(4000, np.random.default_rng(0))[:, :3]
    model = CovariateGaussian.fit(rows, 4000)
    assert np.allclose(model.mean, rows.mean(0), atol=1e-9)
    assert np.allclose(model.covariance, np.cov(rows.T), atol=5e-3)


def test_gaps_that_depend_on_what_is_known_do_not_bend_the_mean():
    """Mass is known of tall people only: the mean of the known is 0.48 too high, that of the fit is not."""
    rows = people(3000, np.random.default_rng(1))[:, :2]
    gapped = rows.copy()
    gapped[rows[:, 0] < 0, 1] = np.nan
    model = CovariateGaussian.fit(gapped, 3000)
    assert np.nanmean(gapped[:, 1]) > 0.4
    assert abs(model.mean[1]) < 0.06
    assert abs(model.covariance[0, 1] - 0.6) < 0.05


def test_three_people_do_not_tie_five_covariates_to_each_other():
    rng = np.random.default_rng(2)
    model = CovariateGaussian.fit(rng.standard_normal((3, 5)), 3)
    filled = model.filled(np.array([[model.mean[0] + 1.0, np.nan, np.nan, np.nan, np.nan]]))[0]
    assert np.all(np.abs(filled - model.mean) < 4 * np.sqrt(np.diag(model.covariance)))
    assert np.all(np.linalg.eigvalsh(model.covariance) > 0)


def test_rows_of_the_caller_are_left_alone():
    rows = np.array([[1.0, np.nan], [2.0, 3.0], [0.0, 1.0]])
    before = rows.copy()
    CovariateGaussian.fit(rows, 3).filled(rows)
    assert np.array_equal(rows, before, equal_nan=True)


WORDS = ["f", "m", "f", None, "m", "x", "f", "m", "f"]


def test_levels_are_those_of_two_people_or_more():
    assert levels_of(WORDS) == ("f", "m")
    assert levels_of(["f", "f", "m"]) == ()
    assert levels_of(None) == ()


def test_the_f_test_is_that_of_scipy_without_people_of_no_level():
    residual = np.random.default_rng(0).standard_normal((9, 4))
    p = f_test(residual, members(WORDS, ("f", "m")))
    own = [residual[[i for i, word in enumerate(WORDS) if word == level]] for level in ("f", "m")]
    assert np.allclose(p, f_oneway(*own).pvalue)


def test_three_levels_are_tested_together():
    words = list("aabbccabc")
    residual = np.random.default_rng(1).standard_normal((9, 3))
    own = [residual[[i for i, word in enumerate(words) if word == level]] for level in "abc"]
    assert np.allclose(f_test(residual, members(words, ("a", "b", "c"))), f_oneway(*own).pvalue)


def test_scores_without_spread_inside_the_levels_cannot_be_tested():
    assert np.isnan(f_test(np.array([[1.0], [2.0], [1.0], [2.0]]), members(["f", "m", "f", "m"], ("f", "m")))[0])


def test_effects_are_level_means_that_weigh_to_zero():
    residual = np.random.default_rng(2).standard_normal((9, 2))
    member = members(WORDS, ("f", "m"))
    effect = level_effects(residual, member)
    assert np.allclose(member.sum(0) @ effect, 0)
    assert np.allclose(effect[0] - effect[1], residual[[0, 2, 6, 8]].mean(0) - residual[[1, 4, 7]].mean(0))


def test_left_out_effects_are_fits_without_the_person():
    rng = np.random.default_rng(3)
    residual, member = rng.standard_normal((9, 9, 2)), members(WORDS, ("f", "m"))
    found = left_out_effects(residual, member)
    for g, word in enumerate(WORDS):
        if word in ("f", "m"):
            others = [h for h in range(9) if h != g]
            effect = level_effects(residual[g][others], member[others])
            assert np.allclose(found[g], effect[("f", "m").index(word)])
        else:
            assert np.all(found[g] == 0)
