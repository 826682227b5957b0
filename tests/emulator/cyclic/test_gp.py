"""Gaussian process regression: scikit-learn 1.9.1's numbers, the naive twin, and what must hold of any such process."""

import numpy as np
import pytest

from emulator.cyclic.gaussian_process import THINNED, Factorisations, GaussianProcess, Hyper, gradient_of
from tests.emulator.cyclic.formulas import NEW, X, Y
from tests.naive import naive_gaussian_process

HYPER = Hyper(np.array([0.8, 1.3, 2.0]), 1.2, 0.3)


def at_unit_scale(hyper=HYPER, x=X, y=Y):
    return GaussianProcess.of(x, y, np.ones(y.shape[1]), hyper, Factorisations({}))


def test_mean_and_spread_are_scikit_learns():
    mean, variance = at_unit_scale().predict(NEW, noise=True)
    frozen = [
        [0.2452962056256398, 0.1345648540968575],
        [-0.8050518089347509, -0.8108584106785601],
        [0.10638349371596167, -0.04174291105197303],
    ]
    assert np.allclose(mean, frozen, atol=1e-10)
    assert np.allclose(
        np.sqrt(variance[:, 0]), [0.37779249949790894, 0.3529469388889437, 1.1438256662287052], atol=1e-10
    )


def test_mean_variance_and_likelihood_are_the_naive_ones():
    process = at_unit_scale()
    mean, variance, log_p = naive_gaussian_process(X, Y, NEW, HYPER.length, HYPER.signal, HYPER.noise)
    assert np.allclose(process.predict(NEW, noise=True)[0], mean, atol=1e-10)
    assert np.allclose(process.predict(NEW, noise=True)[1], variance[:, None], atol=1e-10)
    assert process.log_likelihood == pytest.approx(log_p, abs=1e-9)


def test_without_noise_it_passes_through_its_points():
    mean, variance = at_unit_scale(Hyper(HYPER.length, 1.2, 1e-3)).predict(X)
    assert np.allclose(mean, Y, atol=1e-3) and variance.max() < 1e-5


def test_far_away_it_knows_nothing():
    mean, variance = at_unit_scale().predict(np.full((1, 3), 50.0))
    assert np.allclose(mean, 0) and np.allclose(variance, HYPER.signal**2)


def test_many_repetitions_of_a_point_leave_the_noise_only():
    x = np.zeros((400, 1))
    y = np.random.default_rng(0).normal(0.5, 0.3, (400, 1))
    process = at_unit_scale(Hyper(np.ones(1), 1.0, 0.3), x, y)
    assert process.predict(np.zeros((1, 1)), noise=True)[1][0, 0] == pytest.approx(0.09, rel=0.01)
    assert process.predict(np.zeros((1, 1)))[0][0, 0] == pytest.approx(y.mean(), abs=2e-3)


def test_the_order_of_points_does_not_matter():
    order = np.random.default_rng(1).permutation(len(X))
    assert np.allclose(
        at_unit_scale().predict(NEW)[0], at_unit_scale(x=X[order], y=Y[order]).predict(NEW)[0], atol=1e-10
    )


def test_another_unit_of_the_outputs_changes_nothing_but_the_unit():
    one, thousand = GaussianProcess.fit(X, Y), GaussianProcess.fit(X, 1000 * Y)
    assert np.allclose(1000 * one.predict(NEW)[0], thousand.predict(NEW)[0])
    assert np.allclose(1e6 * one.predict(NEW)[1], thousand.predict(NEW)[1])
    assert one.log_likelihood - thousand.log_likelihood == pytest.approx(Y.size * np.log(1000))


def test_after_a_fit_the_likelihood_is_at_its_top():
    process = GaussianProcess.fit(X, Y, at_most=200)
    inside = (process.hyper.logs > np.log(0.021)) & (process.hyper.logs < np.log(19))
    assert np.abs(gradient_of(process)[inside]).max() < 0.1


def test_500_points_take_at_most_16_factorisations():
    rng = np.random.default_rng(0)
    x = rng.normal(size=(500, 3))
    process = GaussianProcess.fit(x, np.tanh(x) + 0.1 * rng.normal(size=(500, 3)))
    assert process.n_factorisations <= 16
    assert set(process.count.of_size) == {THINNED, 500}


@pytest.mark.parametrize(
    ("x", "y", "words"),
    [(X, Y[:5], "as many outputs"), (X[:1], Y[:1], "two at least"), (np.where(X[3, 0] == X, np.nan, X), Y, "finite")],
)
def test_bad_input_is_refused_in_words(x, y, words):
    with pytest.raises(ValueError, match=words):
        GaussianProcess.fit(x, y)


def test_a_singular_kernel_is_told():
    with pytest.raises(ValueError, match="singular"):
        at_unit_scale(Hyper(np.array([1e3, 1e3, 1e3]), 1e4, 1e-9))
