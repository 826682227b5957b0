import numpy as np
import pytest

from emulator.reduce import JointPCA


def sequences(n=12, p=40, rank=5):
    rng = np.random.default_rng(0)
    return 3 + rng.normal(size=(n, rank)) * np.arange(rank, 0, -1) @ rng.normal(size=(rank, p))


def test_components_are_the_right_singular_vectors():
    x = sequences()
    vectors = np.linalg.svd(x - x.mean(0), full_matrices=False)[2]
    assert np.allclose(np.abs(JointPCA.fit(x, 3).basis @ vectors[:3].T), np.eye(3), atol=1e-10)


def test_all_components_give_the_sequences_back():
    x = sequences()
    pca = JointPCA.fit(x, 5)
    assert np.abs(pca.inverse(pca.forward(x)) - x).max() < 1e-10


def test_a_share_takes_the_fewest_components_that_reach_it():
    x = sequences()
    values = np.linalg.svd(x - x.mean(0), compute_uv=False) ** 2
    share = np.cumsum(values) / values.sum()
    pca = JointPCA.fit(x, 0.9)
    assert share[pca.n_components - 1] >= 0.9 > (share[pca.n_components - 2] if pca.n_components > 1 else 0)
    assert np.isclose(pca.explained_variance, share[pca.n_components - 1])


def test_projection_is_idempotent():
    x = sequences(rank=8)
    pca = JointPCA.fit(x, 3)
    once = pca.inverse(pca.forward(x))
    assert np.allclose(pca.inverse(pca.forward(once)), once)


def test_sequences_without_variance_need_no_component():
    assert JointPCA.fit(np.ones((4, 9))).n_components == 0


@pytest.mark.parametrize("wish", [0, -1, 2.5, 6])
def test_a_number_of_components_that_cannot_be_had_is_refused(wish):
    with pytest.raises(ValueError, match="n_components"):
        JointPCA.fit(sequences(), wish)
