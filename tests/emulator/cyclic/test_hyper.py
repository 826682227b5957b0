"""Hyper-parameters: likelihood and gradient against scikit-learn 1.9.1, a naive twin and finite differences."""

import numpy as np
import pytest

from emulator.cyclic.gaussian_process import Factorisations, Hyper, fitted_hyper, kernel, log_likelihood
from tests.emulator.cyclic.formulas import NEW, X, Y, differences
from tests.naive import naive_covariance, naive_gaussian_process

HYPER = Hyper(np.array([0.8, 1.3, 2.0]), 1.2, 0.3)


def test_the_likelihood_is_scikit_learns():
    assert log_likelihood(HYPER, X, Y)[0] == pytest.approx(
        -38.36215367260906, abs=1e-6
    )  # it adds 1e-10 to the diagonal


def test_the_gradient_is_scikit_learns():
    """scikit-learn differentiates by log signal^2, log lengths, log noise^2: twice the change of a logarithm."""
    gradient = log_likelihood(HYPER, X, Y)[1]
    frozen = [20.172052215135842, 6.4262014704290396, 6.63283239922687, 2 * -9.032470028730941, 2 * -19.771517873296755]
    assert np.allclose(gradient, frozen, atol=1e-8)


def test_the_gradient_is_that_of_finite_differences():
    found = log_likelihood(HYPER, X, Y)[1]
    by_difference = differences(lambda logs: log_likelihood(Hyper.from_logs(logs), X, Y)[0], HYPER.logs)
    assert np.allclose(found, by_difference, atol=1e-6)


def test_kernel_and_likelihood_are_the_naive_ones():
    assert np.allclose(kernel(X, NEW, HYPER), naive_covariance(X, NEW, HYPER.length, HYPER.signal), atol=1e-12)
    naive = naive_gaussian_process(X, Y, NEW, HYPER.length, HYPER.signal, HYPER.noise)[2]
    assert log_likelihood(HYPER, X, Y)[0] == pytest.approx(naive, abs=1e-9)


def test_the_search_finds_what_scikit_learn_finds_with_four_starts():
    unit = Y / np.sqrt((Y * Y).mean(axis=0))
    assert log_likelihood(fitted_hyper(X, unit, at_most=100), X, unit)[0] > -0.8603717400582553 - 1e-3


def test_the_search_makes_no_more_factorisations_than_it_may():
    count = Factorisations({})
    fitted_hyper(X, Y, at_most=7, count=count)
    assert count.of_size == {40: 7}


def test_known_lengths_are_found_again():
    rng = np.random.default_rng(4)
    x = rng.uniform(-2, 2, (250, 2))
    truth = Hyper(np.array([0.5, 2.0]), 1.0, 0.1)
    y = np.linalg.cholesky(kernel(x, x, truth) + 0.01 * np.eye(250)) @ rng.standard_normal((250, 4))
    found = fitted_hyper(x, y)
    assert np.allclose(found.logs, truth.logs, atol=0.2)


def test_lengths_that_are_not_positive_are_refused():
    with pytest.raises(ValueError, match="must be positive"):
        Hyper(np.array([1.0, 0.0]), 1.0, 0.1)
