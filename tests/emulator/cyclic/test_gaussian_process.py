"""Gaussian process regression: scikit-learn 1.9.1's numbers, the naive twin, and what must hold of any such process.

Hyper-parameters: likelihood and gradient against scikit-learn 1.9.1, a naive twin and finite differences.

Gaussian process classification: scikit-learn 1.9.1's numbers, finite differences, and sense on made states.
"""

import numpy as np
import pytest

from emulator.cyclic.gaussian_process import (
    THINNED,
    Factorisations,
    GaussianProcess,
    Hyper,
    fitted_hyper,
    gradient_of,
    kernel,
    log_likelihood,
)
from emulator.cyclic.gp_classifier import StateClassifier, log_evidence, mode_of, telling_points
from tests.emulator.cyclic.formulas import NEW, POSITIVE, THREE, X, Y, differences
from tests.naive import naive_covariance, naive_gaussian_process

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


MEDIUM = Hyper(np.array([0.8, 1.3, 2.0]), 1.2, 0.3)


def test_the_likelihood_is_scikit_learns():
    assert log_likelihood(MEDIUM, X, Y)[0] == pytest.approx(
        -38.36215367260906, abs=1e-6
    )  # it adds 1e-10 to the diagonal


def test_the_gradient_is_scikit_learns():
    """scikit-learn differentiates by log signal^2, log lengths, log noise^2: twice the change of a logarithm."""
    gradient = log_likelihood(MEDIUM, X, Y)[1]
    frozen = [20.172052215135842, 6.4262014704290396, 6.63283239922687, 2 * -9.032470028730941, 2 * -19.771517873296755]
    assert np.allclose(gradient, frozen, atol=1e-8)


def test_the_gradient_is_that_of_finite_differences():
    found = log_likelihood(MEDIUM, X, Y)[1]
    by_difference = differences(lambda logs: log_likelihood(Hyper.from_logs(logs), X, Y)[0], MEDIUM.logs)
    assert np.allclose(found, by_difference, atol=1e-6)


def test_kernel_and_likelihood_are_the_naive_ones():
    assert np.allclose(kernel(X, NEW, MEDIUM), naive_covariance(X, NEW, MEDIUM.length, MEDIUM.signal), atol=1e-12)
    naive = naive_gaussian_process(X, Y, NEW, MEDIUM.length, MEDIUM.signal, MEDIUM.noise)[2]
    assert log_likelihood(MEDIUM, X, Y)[0] == pytest.approx(naive, abs=1e-9)


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


SMOOTH = Hyper(np.array([0.8, 1.3, 2.0]), 1.7, 0.1)
NOTHING = np.zeros(len(X))


def test_the_evidence_and_its_gradient_are_scikit_learns():
    value, gradient, _ = log_evidence(SMOOTH, X, POSITIVE, NOTHING)
    assert value == pytest.approx(-19.52106969498181, abs=1e-7)
    frozen = [-0.9564393106676786, -0.745307961474087, 1.6756506750140174, 2 * 1.631642754105121, 0.0]
    assert np.allclose(gradient, frozen, atol=1e-4)


def test_the_gradient_is_that_of_finite_differences_of_the_evidence():
    def value(logs):
        return log_evidence(Hyper.from_logs(logs), X, POSITIVE, NOTHING)[0]

    assert np.allclose(log_evidence(SMOOTH, X, POSITIVE, NOTHING)[1], differences(value, SMOOTH.logs), atol=1e-4)


def test_latents_and_probabilities_are_scikit_learns():
    """Probabilities to 0.005: scikit-learn averages the logistic by five error functions, we by MacKay's formula."""
    classifier = StateClassifier.fit(X, POSITIVE, hyper=SMOOTH)
    assert np.allclose(
        classifier.latents(NEW)[:, 1], [0.7678035210454048, 0.5145354846959375, -0.15756952988695402], atol=1e-5
    )
    assert np.allclose(
        classifier.probability(NEW)[:, 1], [0.6608111433329782, 0.6089955655938297, 0.47351020549448464], atol=0.005
    )


def test_three_states_have_scikit_learns_probabilities():
    frozen = [
        [0.22218857830954133, 0.4191696972809652, 0.35864172440949343],
        [0.1696684599522361, 0.7390217726939847, 0.09130976735377924],
        [0.290363890674421, 0.2956906439148247, 0.41394546541075433],
    ]
    classifier = StateClassifier.fit(X, THREE, hyper=SMOOTH)
    assert np.allclose(classifier.probability(NEW), frozen, atol=0.005)
    assert np.array_equal(classifier.state(X), THREE)


def test_at_the_mode_the_latent_is_the_kernel_times_the_gradient():
    covariance = kernel(X, X, SMOOTH)
    mode = mode_of(covariance, POSITIVE)
    assert np.allclose(mode.latent, covariance @ mode.weight, atol=1e-6)


def test_the_search_finds_evidence_as_good_as_scikit_learns_with_three_starts():
    process = StateClassifier.fit(X, POSITIVE).processes[0]
    assert process.mode.log_evidence > -17.066894749723495 - 0.1


def test_states_keep_their_numbers_and_probabilities_sum_to_one():
    classifier = StateClassifier.fit(X, THREE * 5 - 3)
    assert set(classifier.state(X)) == {-3, 2, 7}
    assert np.allclose(classifier.probability(NEW).sum(axis=1), 1)


def test_a_single_state_needs_no_process():
    classifier = StateClassifier.fit(X, np.full(len(X), 4))
    assert classifier.state(NEW).tolist() == [4, 4, 4] and classifier.probability(NEW).tolist() == [[1.0]] * 3


def test_a_curved_border_is_found_from_few_of_many_points():
    rng = np.random.default_rng(2)
    x, new = rng.normal(size=(2, 3000, 3))
    state = (np.hypot(x[:, 0], x[:, 1]) > 1).astype(int)
    classifier = StateClassifier.fit(x, state)
    assert len(classifier.processes[0].x) <= 160
    assert np.mean(classifier.state(new) == (np.hypot(new[:, 0], new[:, 1]) > 1)) > 0.96


def test_every_state_is_among_the_telling_points():
    x = np.random.default_rng(0).normal(size=(500, 2))
    state = np.zeros(500, dtype=int)
    state[7] = 1
    chosen = telling_points(x, state, 20)
    assert 7 in chosen and len(chosen) <= 20 + 2


def test_states_and_points_must_agree():
    with pytest.raises(ValueError, match="one state a point"):
        StateClassifier.fit(X, THREE[:-1])
