import numpy as np
import pytest

from emulator.model.reduction import JointPCA, SequentialPCA


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


def courses(n=9, t=14, c=6, rank=4):
    """n sequences (n, T, C) whose postures span ``rank`` directions."""
    rng = np.random.default_rng(1)
    return 2 + rng.normal(size=(n, t, rank)) * np.arange(rank, 0, -1) @ rng.normal(size=(rank, c))


def test_sequential_components_are_those_of_both_covariances():
    """Chen, Park & Srivastava sec. 4.2 by steps: covariance of all postures, then of each spatial score over time."""
    x = courses()
    pca = SequentialPCA.fit(x, 3, 2)
    postures = x.reshape(-1, 6)
    spatial = np.linalg.eigh(np.cov(postures.T, bias=True))[1][:, ::-1][:, :3].T
    assert np.allclose(np.abs(pca.spatial @ spatial.T), np.eye(3), atol=1e-8)
    for i, scores in enumerate(np.moveaxis((x - postures.mean(0)) @ pca.spatial.T, -1, 0)):
        temporal = np.linalg.eigh(np.cov(scores.T, bias=True))[1][:, ::-1][:, :2].T
        assert np.allclose(np.abs(pca.temporal[i] @ temporal.T), np.eye(2), atol=1e-6)
    assert pca.n_components == 6


def test_all_sequential_components_give_the_sequences_back():
    x = courses()
    pca = SequentialPCA.fit(x, 4, 8)
    assert np.abs(pca.inverse(pca.forward(x)) - x).max() < 1e-9


def test_sequential_coefficients_come_back_from_their_sequence():
    pca = SequentialPCA.fit(courses(), 2, 3)
    a = np.random.default_rng(2).normal(size=(5, 6))
    assert np.allclose(pca.forward(pca.inverse(a)), a)
    assert np.allclose(pca.forward(pca.inverse(a[0])), a[0])


def test_more_sequential_components_lose_less_of_what_they_were_fitted_to():
    x = courses()
    fits = [[SequentialPCA.fit(x, d1, d2) for d2 in (1, 3, 5)] for d1 in (1, 2, 4)]
    error = [[np.sum((pca.inverse(pca.forward(x)) - x) ** 2) for pca in row] for row in fits]
    assert np.all(np.diff(error, axis=0) < 0) and np.all(np.diff(error, axis=1) < 0)


def test_shares_take_the_fewest_components_that_reach_them():
    x = courses()
    values = np.linalg.eigvalsh(np.cov(x.reshape(-1, 6).T))[::-1]
    share = np.cumsum(values) / values.sum()
    pca = SequentialPCA.fit(x, float(share[1]) - 1e-6, 0.5)
    assert len(pca.spatial) == 2
    for scores in np.moveaxis((x - pca.mean) @ pca.spatial.T, -1, 0):
        of_time = np.linalg.svd(scores - scores.mean(0), compute_uv=False) ** 2
        assert of_time[: pca.temporal.shape[1]].sum() >= 0.5 * of_time.sum()


@pytest.mark.parametrize(("d1", "d2", "name"), [(0, 2, "d1"), (5, 2, "d1"), (2, 9, "d2"), (2, 1.5, "d2")])
def test_a_number_of_sequential_components_that_cannot_be_had_is_refused(d1, d2, name):
    with pytest.raises(ValueError, match=f"{name}: found"):
        SequentialPCA.fit(courses(), d1, d2)
