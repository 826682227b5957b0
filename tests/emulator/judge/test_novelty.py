import numpy as np

from emulator.judge import novelty
from tests.emulator.judge.made import plain_distances


def ratio(drawn, unseen, training):
    return novelty(plain_distances(drawn, training), plain_distances(unseen, training))


def sample(seed, n=60):
    return np.random.default_rng(seed).normal(size=(n, 4))


def test_a_copier_has_no_novelty_and_a_new_sample_about_one():
    assert ratio(sample(0)[:20], sample(1), sample(0)) == 0
    assert 0.85 < ratio(sample(2, 200), sample(1), sample(0)) < 1.15


def test_too_wide_a_law_is_too_new():
    assert ratio(2 * sample(2), sample(1), sample(0)) > 1.5


def test_novelty_is_not_estimable_where_the_unseen_are_copies():
    assert np.isnan(ratio(sample(2), sample(0)[:9], sample(0)))
