import numpy as np
import pytest

from emulator.model.gaussian import Law, LowRankNormal, chosen, placed, regression


def normal(k=3, seed=1, mean=None):
    rows = np.random.default_rng(seed).normal(size=(6, k)) / 3
    return LowRankNormal.of_rows(np.zeros(k) if mean is None else mean, rows, 0.0)


def mixture(people=None):
    mean = np.array([[-2.0, 0.0, 1.0], [0.0, 1.0, 0.0], [3.0, -1.0, 0.0]])
    weight, reach, centre = np.array([0.5, 0.3, 0.2]), np.array([0.5, 1.0, 2.0]), np.array([1.0, 0.0, 0.0])
    return Law(weight, mean, reach, normal(), centre, people)


def density(law, z):
    """The law's density at z (n, K) by scipy, component by component."""
    from scipy.stats import multivariate_normal

    mean, covariance = law.coordinates(np.arange(z.shape[1]))
    return sum(w * multivariate_normal(m, c).pdf(z) for w, m, c in zip(law.weight, mean, covariance))


def test_draws_have_the_mean_and_covariance_of_the_mixture():
    law = mixture(people=normal(seed=2, mean=np.array([0.0, 5.0, 0.0])))
    mean, covariance = law.coordinates(np.arange(3))
    whole = law.weight @ mean
    spread = np.einsum("m,mij->ij", law.weight, covariance) + np.cov(mean.T, aweights=law.weight, ddof=0)
    z = law.sample(200_000, np.random.default_rng(0))
    size = np.sqrt(np.diag(spread))
    assert np.abs((z.mean(0) - whole) / size).max() < 5 / np.sqrt(200_000)
    assert np.abs((np.cov(z.T) - spread) / np.outer(size, size)).max() < 0.02


def test_one_component_without_people_is_the_plain_gaussian():
    noise, centre = normal(), np.array([1.0, 2.0, 3.0])
    law = Law(np.ones(1), np.zeros((1, 3)), np.ones(1), noise, centre)
    drawn = [law.sample(8, np.random.default_rng(3)), centre + noise.sample(8, np.random.default_rng(3))]
    assert np.allclose(*drawn, atol=1e-15)


def test_given_a_coordinate_the_others_follow_its_conditional_law():
    law, value = mixture(people=normal(seed=2)), 0.7
    z = law.sample(100_000, np.random.default_rng(0), given=(0, np.full(100_000, value)))
    assert np.allclose(z[:, 0], value, atol=1e-12)
    grid = np.stack(np.meshgrid(*[np.linspace(-8, 8, 161)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    weight = density(law, np.column_stack([np.full(len(grid), value), grid]))
    expected = weight @ grid / weight.sum()
    second = (weight @ grid**2) / weight.sum()
    assert np.abs(z[:, 1:].mean(0) - expected).max() < 0.02
    assert np.abs((z[:, 1:] ** 2).mean(0) / second - 1).max() < 0.03


def test_conditional_weights_are_those_of_bayes_rule():
    from scipy.stats import norm

    law = mixture()
    mean, covariance = law.coordinates(np.array([1]))
    prior = law.weight * norm(mean[:, 0], np.sqrt(covariance[:, 0, 0])).pdf(0.4)
    assert np.allclose(law.weight_given(1, np.array([0.4]))[0], prior / prior.sum())


@pytest.mark.parametrize("shape", [(), (5,)])
def test_components_are_chosen_as_often_as_they_weigh(shape):
    weight = np.array([0.5, 0.0, 0.3, 0.2])
    u = np.random.default_rng(0).random(20_000)
    at = placed(np.cumsum(weight), u) if not shape else chosen(np.tile(weight, (len(u), 1)), u)
    assert np.abs(np.bincount(at, minlength=4) / len(u) - weight).max() < 0.015
    assert not np.any(at == 1)


def test_a_number_of_one_chooses_the_last_component():
    assert placed(np.array([0.5, 1.0]), np.array([1.0])).tolist() == [1]
    assert chosen(np.array([[0.5, 0.5]]), np.array([1.0])).tolist() == [1]


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


def test_slopes_are_covariances_over_the_variance():
    assert regression(np.array([2.0, 4.0, -1.0]), 0).tolist() == [1.0, 2.0, -0.5]
    assert regression(np.array([3.0, 0.0]), 1).tolist() == [0.0, 1.0]  # what does not vary tells of nothing
