"""Gaussian process classification: scikit-learn 1.9.1's numbers, finite differences, and sense on made states."""

import numpy as np
import pytest

from emulator.cyclic.gaussian_process import Hyper, kernel
from emulator.cyclic.gp_classifier import StateClassifier, log_evidence, mode_of, telling_points
from tests.emulator.cyclic.formulas import NEW, POSITIVE, THREE, X, differences

HYPER = Hyper(np.array([0.8, 1.3, 2.0]), 1.7, 0.1)
NOTHING = np.zeros(len(X))


def test_the_evidence_and_its_gradient_are_scikit_learns():
    value, gradient, _ = log_evidence(HYPER, X, POSITIVE, NOTHING)
    assert value == pytest.approx(-19.52106969498181, abs=1e-7)
    frozen = [-0.9564393106676786, -0.745307961474087, 1.6756506750140174, 2 * 1.631642754105121, 0.0]
    assert np.allclose(gradient, frozen, atol=1e-4)


def test_the_gradient_is_that_of_finite_differences():
    def value(logs):
        return log_evidence(Hyper.from_logs(logs), X, POSITIVE, NOTHING)[0]

    assert np.allclose(log_evidence(HYPER, X, POSITIVE, NOTHING)[1], differences(value, HYPER.logs), atol=1e-4)


def test_latents_and_probabilities_are_scikit_learns():
    """Probabilities to 0.005: scikit-learn averages the logistic by five error functions, we by MacKay's formula."""
    classifier = StateClassifier.fit(X, POSITIVE, hyper=HYPER)
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
    classifier = StateClassifier.fit(X, THREE, hyper=HYPER)
    assert np.allclose(classifier.probability(NEW), frozen, atol=0.005)
    assert np.array_equal(classifier.state(X), THREE)


def test_at_the_mode_the_latent_is_the_kernel_times_the_gradient():
    covariance = kernel(X, X, HYPER)
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
