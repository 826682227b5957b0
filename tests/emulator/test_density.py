import numpy as np
import pytest

from emulator.model.gaussian import LowRankNormal


def scores(n=40, k=5):
    rng = np.random.default_rng(1)
    return rng.normal(size=(n, k)) @ rng.normal(size=(k, k)) + 2


def test_with_rho_zero_the_covariance_is_that_of_the_scores():
    x = scores()
    assert np.allclose(LowRankNormal.fit(x, 0.0).covariance, np.cov(x.T))


def test_rho_shrinks_correlations_and_leaves_variances():
    x = scores()
    shrunk, sample = LowRankNormal.fit(x, 0.3).covariance, np.cov(x.T)
    assert np.allclose(np.diag(shrunk), np.diag(sample))
    assert np.allclose(shrunk - np.diag(np.diag(shrunk)), 0.7 * (sample - np.diag(np.diag(sample))))


def test_the_covariance_with_one_coefficient_is_its_column():
    model = LowRankNormal.fit(scores(), 0.2)
    assert np.allclose(model.covariance_with(3), model.covariance[:, 3])


def test_draws_have_the_mean_and_covariance():
    model = LowRankNormal.fit(scores(), 0.1)
    draws = model.sample(200_000, np.random.default_rng(0))
    size = np.sqrt(np.diag(model.covariance))
    assert np.abs((draws.mean(0) - model.mean) / size).max() < 5 / np.sqrt(200_000)
    assert np.abs((np.cov(draws.T) - model.covariance) / np.outer(size, size)).max() < 0.02


def test_more_coefficients_than_sequences_stay_in_the_span_of_the_data():
    x = scores(6, 30)
    model = LowRankNormal.fit(x, 0.0)
    assert len(model.factor) == 5
    draws = model.sample(20, np.random.default_rng(0)) - model.mean
    assert np.linalg.matrix_rank(np.concatenate([draws, x - x.mean(0)]), tol=1e-8) == 5


def test_the_log_likelihood_is_that_of_scipy_where_the_covariance_is_regular():
    from scipy.stats import multivariate_normal

    model, x = LowRankNormal.fit(scores(), 0.1), scores()[:4] + 0.3
    assert np.allclose(model.log_likelihood(x), multivariate_normal(model.mean, model.covariance).logpdf(x))


def test_the_log_likelihood_of_a_singular_covariance_is_that_of_its_subspace():
    from scipy.stats import norm

    model = LowRankNormal(np.zeros(2), np.array([[3.0, 4.0]]), np.array([3.0, 4.0]), 0.0)
    assert np.allclose(model.log_likelihood(np.array([[0.6, 0.8]])), norm(0, 5).logpdf(1.0))


def test_the_same_generator_gives_the_same_bytes():
    model = LowRankNormal.fit(scores(), 0.1)
    one, two = (model.sample(64, np.random.default_rng(5)).tobytes() for _ in range(2))
    assert one == two


@pytest.mark.parametrize("rho", [-0.1, 1.1])
def test_a_rho_that_is_no_share_is_refused(rho):
    with pytest.raises(ValueError, match="rho"):
        LowRankNormal.fit(scores(), rho)


def test_one_sequence_is_refused():
    with pytest.raises(ValueError, match="2 sequences"):
        LowRankNormal.fit(scores(1))
