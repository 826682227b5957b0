import numpy as np

from emulator.posture_size import _lost, posture_size
from emulator.reduce import JointPCA


def sequences(n=40, rank=6, noise=0.01, p=300, seed=0):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, rank)) @ rng.normal(size=(rank, p)) + noise * rng.normal(size=(n, p))


def test_the_errors_are_those_of_components_fitted_to_the_others():
    x, held = sequences(), np.arange(40) % 5 == 2
    lost = _lost(x @ x.T, held, 10)
    for size in (1, 4, 9):
        pca = JointPCA.fit(x[~held], size)
        left = x[held] - pca.inverse(pca.forward(x[held]))
        assert np.allclose(lost[:, size - 1], np.sum(left**2, axis=1))


def test_the_rank_of_made_sequences_is_found():
    for rank in (6, 11):
        assert rank <= posture_size(sequences(rank=rank)) <= rank + 1


def test_the_number_is_bounded_by_what_few_sequences_span():
    assert posture_size(sequences(n=4, rank=10, noise=0.0)) <= 3


def test_no_variation_needs_no_more_than_one_component():
    assert posture_size(np.ones((5, 20))) == 1
