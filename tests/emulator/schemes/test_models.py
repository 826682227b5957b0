"""The law of all densities, and what is particular to one."""

import re
from dataclasses import replace

import numpy as np
import pytest

from emulator.judge import temporal_roughness
from emulator.schemes import Scheme
from emulator.schemes.densities import DENSITIES, VAR, KernelDensity, VectorModel
from emulator.schemes.flattening import Pointwise
from tests.emulator.schemes.cases import grid_case, series_case, walks

N = 20_000
LAZY = np.eye(2)[None]
"""Each score as it was: the modulus is 1."""


def rows(n=30, k=3):
    rng = np.random.default_rng(1)
    return rng.normal(size=(n, k)) @ rng.normal(size=(k, k)) + 2


def paths(n=30, n_times=6, d=2):
    """(n, T, d) scores that go up and down by a stable rule."""
    rng = np.random.default_rng(2)
    y = np.zeros((n, n_times + 20, d))
    for t in range(1, y.shape[1]):
        y[:, t] = 0.3 + y[:, t - 1] @ np.array([[0.6, 0.2], [-0.3, 0.5]]) + 0.1 * rng.normal(size=(n, d))
    return y[:, 20:]


def models():
    """name -> (model, training scores, training starts)."""
    x, start, series, none = rows(), rows(30, 2)[:, :2], paths(), np.zeros((30, 0))
    made = {name: (VectorModel.fit(name, x, start), x, start) for name in DENSITIES}
    made |= {name: (Pointwise.fit(series, name != "PWI"), series, none) for name in ("PWI", "PWI/shared")}
    rng = np.random.default_rng(0)
    return made | {"VAR-pooled": (VAR.fit(series, start, rng, pooled=True, order=1), series, start)}


@pytest.mark.parametrize("name", [*DENSITIES, "PWI", "PWI/shared", "VAR-pooled"])
def test_draws_have_the_mean_and_spread_of_the_training_and_the_same_seed_gives_the_same_bytes(name):
    model, x, start = models()[name]
    drawn, of_start = model.sample(N, np.random.default_rng(3))
    for got, seen in ((drawn, x), (of_start, start)):
        if seen.shape[1]:
            assert got.shape[1:] == seen.shape[1:]
            size = seen.std(axis=0, ddof=1)
            loose = 0.25 * size if name == "VAR-pooled" else 0  # a rule for all times has no mean for each
            assert np.all(np.abs(got.mean(axis=0) - seen.mean(axis=0)) < 5 * size / np.sqrt(N) + loose)
            assert np.all(np.abs(got.std(axis=0) / size - 1) < (0.3 if name == "VAR-pooled" else 0.03))
    again = models()[name][0].sample(50, np.random.default_rng(3))
    assert [part.tobytes() for part in again] == [part.tobytes() for part in model.sample(50, np.random.default_rng(3))]


@pytest.mark.parametrize("name", [*DENSITIES, "PWI", "PWI/shared", "VAR-pooled"])
def test_own_draws_are_likelier_than_draws_moved_apart_and_one_by_one_as_in_a_batch(name):
    model = models()[name][0]
    drawn, start = model.sample(400, np.random.default_rng(4))
    apart = model.log_likelihood(drawn + 3 * (drawn - drawn.mean(axis=0)), start)
    together = model.log_likelihood(drawn, start)
    assert np.mean(together) > np.mean(apart) + 1
    one = model.log_likelihood(drawn[7], start[7])
    assert one.shape == () and np.isclose(one, together[7])


@pytest.mark.parametrize("name", DENSITIES)
def test_densities_of_vectors_integrate_to_one(name):
    x = rows(40, 2)
    model = VectorModel.fit(name, x, np.zeros((40, 0)))
    middle, size = x.mean(axis=0), x.std(axis=0)
    sides = [np.linspace(m - 7 * s, m + 7 * s, 300) for m, s in zip(middle, size)]
    grid = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1)
    density = np.exp(model.log_likelihood(grid, np.zeros((300, 300, 0))))
    assert np.isclose(density.sum() * np.prod([side[1] - side[0] for side in sides]), 1, atol=1e-3)


def test_regular_gaussians_have_the_log_density_of_scipy():
    from scipy.stats import multivariate_normal

    x, none = rows(), np.zeros((30, 0))
    covariance = np.cov(x.T)
    for name, matrix in (("MVG", covariance), ("IG", np.diag(np.diag(covariance)))):
        expected = multivariate_normal(x.mean(axis=0), matrix).logpdf(x)
        assert np.allclose(VectorModel.fit(name, x, none).log_likelihood(x, none), expected)
    y = paths()
    expected = sum(multivariate_normal(y[:, t].mean(axis=0), np.cov(y[:, t].T)).logpdf(y)[:, t] for t in range(6))
    assert np.allclose(Pointwise.fit(y, False).log_likelihood(y, none), expected)
    whole = multivariate_normal(y.reshape(30, 12).mean(axis=0), np.cov(y.reshape(30, 12).T)).logpdf(y.reshape(30, 12))
    assert np.allclose(Pointwise.fit(y, True).log_likelihood(y, none), whole)


def test_a_kernel_keeps_covariances_and_draws_as_far_off_as_a_sequence_left_out():
    x = np.concatenate([rows(20, 3), rows(20, 3) + 9])
    model = KernelDensity.fit(x)
    assert 0 < model.share < 0.5
    drawn = model.sample(N, np.random.default_rng(0))
    assert np.allclose(np.cov(drawn.T), np.cov(x.T), rtol=0.05)
    apart = np.linalg.norm(x[:, None] - x, axis=-1) + np.diag(np.full(40, np.inf))
    nearest = np.linalg.norm(drawn[:2000, None] - x, axis=-1).min(axis=1)
    assert abs(np.log(np.median(nearest) / np.median(apart.min(axis=1)))) < 0.3
    held = rows(20, 3)
    gaussian = VectorModel.fit("MVG", x, x[:, :0])
    assert model.log_likelihood(held).mean() > gaussian.log_likelihood(held, held[:, :0]).mean()
    assert np.all(np.isneginf(KernelDensity.fit(x, share=0.0).log_likelihood(held)))


@pytest.mark.parametrize(
    ("share", "theirs"),
    [
        (0.3, [-2.545075733208, -2.394804858722, -11.531889910038, -25.45084226741]),
        (0.05, [-3.217561591664, -0.122911253384, -46.033931237367, -121.315398733217]),
    ],
)
def test_a_kernel_density_is_that_of_scikit_learn(share, theirs):
    """scikit-learn 1.9.1, of the centres and in the coordinates in which our noise is round:

    w = inv(cholesky(cov(x.T))).T; centres = mean + sqrt((1 - share) * 12 / 11) * (x - mean)
    KernelDensity(bandwidth=sqrt(share), rtol=0, atol=0).fit(centres @ w).score_samples(asked @ w) + log(det(w))
    """
    x = grid_case(12, 3)
    asked = np.array([x.mean(axis=0), x[4], x[0] + 1, x[7] - [3, 0, 2]])
    assert np.allclose(KernelDensity.fit(x, share).log_likelihood(asked), theirs, rtol=1e-10)


@pytest.mark.parametrize(
    ("order", "modulus", "first_lag"),
    [
        (2, 0.953085459930861, [[1.023139, -0.03820799, 0.23715259], [-0.03916006, 1.49276554, -0.06992852]]),
        (3, 0.9386348055173365, [[1.07145965, -0.10578814, 0.09393702], [0.29303845, 1.41939946, -0.35868703]]),
    ],
)
def test_a_var_is_that_of_statsmodels(order, modulus, first_lag):
    """statsmodels 0.15.0, VAR(y).fit(p): params (rows are the lagged variables), and the largest of 1 / |roots|."""
    model = VAR.fit(series_case(), np.zeros((2, 0)), np.random.default_rng(0), pooled=False, order=order)
    assert np.isclose(model.modulus, modulus, rtol=1e-10)
    assert np.allclose(model.lags[0].T[:2], first_lag, atol=5e-9)
    if order == 2:
        assert np.allclose(model.intercept, [0.05738075, 0.08729759, -0.00670874], atol=5e-9)
        expected = [[0.1332536, 0.00059547, -0.04280972], [0.00059547, 0.04970186, 0.01115034]]
        assert np.allclose(model.noise.covariance[:2], expected, atol=5e-8)


def test_the_log_density_of_a_var_is_that_of_its_innovations_and_its_start():
    from scipy.stats import multivariate_normal

    model, y, start = models()["VAR-pooled"]
    error = y[:, 1:] - model.intercept - y[:, :-1] @ model.lags[0].T
    inner = multivariate_normal(np.zeros(2), model.noise.covariance).logpdf(error).sum(axis=1)
    of_start = multivariate_normal(start.mean(axis=0), np.cov(start.T)).logpdf(start)
    assert np.allclose(model.log_likelihood(y, start), inner + of_start)


def test_a_pooled_var_finds_the_rule_again():
    model = VAR.fit(paths(400, 40), np.zeros((400, 0)), np.random.default_rng(0), pooled=True, order=1)
    assert np.allclose(model.lags[0].T, [[0.6, 0.2], [-0.3, 0.5]], atol=0.02)
    assert np.isclose(model.modulus, np.abs(np.linalg.eigvals([[0.6, 0.2], [-0.3, 0.5]])).max(), atol=0.02)


def test_an_exploding_var_is_not_drawn_from_unless_asked():
    t = np.arange(40.0)
    growing = (1.05**t)[None, :, None] * np.array([1.0, 1.3])[:, None, None]
    growing = growing + 0.01 * np.random.default_rng(0).normal(size=(2, 40, 1))
    model = VAR.fit(growing, np.zeros((2, 0)), np.random.default_rng(0), pooled=True, order=1)
    with pytest.raises(ValueError, match=r"modulus is 1\.0\d+.*allow_unstable"):
        model.sample(3, np.random.default_rng(0))
    scores, _ = model.sample(3, np.random.default_rng(0), allow_unstable=True)
    assert np.all(scores[:, -1] > 4 * scores[:, 0])


@pytest.mark.parametrize(
    ("rate", "said"),
    [
        (1.00002, "1.00002"),
        (1.0000004, "1.0000004"),
        (1.00996, "1.0100"),
        (1.0, "1"),
        (1 + 2**-52, "1.0000000000000002"),
    ],
)
def test_a_modulus_is_said_with_the_digits_that_tell_it_from_one(rate, said):
    """A rule that is refused for 1.0000 reads like a mistake of ours."""
    model = replace(
        VAR.fit(paths(), np.zeros((30, 0)), np.random.default_rng(0), pooled=True, order=1), lags=rate * LAZY
    )
    with pytest.raises(ValueError, match=rf"modulus is {re.escape(said)}, from 1 on"):
        model.sample(3, np.random.default_rng(0))


def test_a_modulus_just_below_one_is_drawn_from():
    model = VAR.fit(paths(), np.zeros((30, 0)), np.random.default_rng(0), pooled=True, order=1)
    below = replace(model, lags=0.999999 * LAZY)
    assert np.isfinite(below.sample(3, np.random.default_rng(0))[0]).all()


def test_the_advice_is_another_one_for_a_rule_that_is_pooled_already():
    y, none = paths(), np.zeros((30, 0))
    for pooled, advice in ((True, "fit a lower order, or"), (False, "fit VAR-pooled or a lower order, or")):
        model = VAR.fit(y, none, np.random.default_rng(0), pooled=pooled, order=1)
        with pytest.raises(ValueError, match=advice):
            replace(model, lags=1.1 * LAZY).sample(3, np.random.default_rng(0))


def test_numbers_beyond_all_numbers_are_refused_even_when_asked_for():
    model = VAR.fit(paths(), np.zeros((30, 0)), np.random.default_rng(0), pooled=True, order=1)
    beyond = replace(model, lags=1e200 * LAZY, n_times=20)
    with pytest.raises(ValueError, match=r"exploded beyond all numbers; its companion modulus is 1e\+200"):
        beyond.sample(3, np.random.default_rng(0), allow_unstable=True)


def test_a_var_takes_the_order_that_the_points_allow_and_refuses_more():
    y, none, rng = paths(3, 30), np.zeros((3, 0)), np.random.default_rng(0)
    largest = VAR.fit(y, none, rng, pooled=False).order
    assert largest == 9 and VAR.fit(y, none, rng, pooled=True).order == 12
    for order in (10, 0, 1.5):
        with pytest.raises(ValueError, match=r"can tell an order from 1 to 9"):
            VAR.fit(y, none, rng, pooled=False, order=order)


def test_pointwise_draws_are_rough_and_one_latent_for_all_times_cures_it():
    y = walks(20, 100, 6)
    trained = temporal_roughness(y)
    rough, smooth = (
        temporal_roughness(Scheme.fit(y, name).sample(50, np.random.default_rng(0))) for name in ("PWI", "PWI/shared")
    )
    assert rough > 8 * trained and 0.9 < smooth / trained < 1.1
