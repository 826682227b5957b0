import numpy as np
import pytest

from emulator.judge.sequence_distances import mds, mds_of_two
from tests.emulator.judge.made import parts, plain_distances


def test_three_points_on_a_line_by_hand():
    """0, 1, 3: centred at 4/3; the farthest from the centre, 3, lies on the positive side."""
    line = np.array([[0.0], [1.0], [3.0]])
    found = mds(plain_distances(line, line), 1)
    assert np.allclose(found.points[:, 0], [-4 / 3, -1 / 3, 5 / 3])
    assert np.isclose(found.explained[0], 1) and found.negative < 1e-12


def test_points_of_the_plane_come_back_with_their_distances():
    x = np.random.default_rng(0).normal(size=(40, 2))
    d = plain_distances(x, x)
    again = mds(d).points
    assert np.allclose(plain_distances(again, again), d, atol=1e-9)
    assert np.allclose(again.mean(axis=0), 0, atol=1e-9) and np.ptp(again[:, 0]) > np.ptp(again[:, 1])


def test_turning_shifting_and_reordering_change_nothing():
    rng = np.random.default_rng(1)
    x = rng.normal(size=(30, 4))
    turn, order = np.linalg.qr(rng.normal(size=(4, 4)))[0], rng.permutation(30)
    one, other = x, x[order] @ turn + 3.0
    first, second = (mds(plain_distances(p, p)).points for p in (one, other))
    assert np.allclose(first[order], second, atol=1e-7)


def test_four_points_around_a_square_as_an_eigenproblem_by_hand():
    """Shortest ways around a ring of four are not Euclidean: eigenvalues 2, 2, 0 (the centre) and -1."""
    ring = np.array([[0, 1, 2, 1], [1, 0, 1, 2], [2, 1, 0, 1], [1, 2, 1, 0]], float)
    found = mds(ring)
    assert np.allclose(np.sum(found.points**2, axis=0), [2, 2]) and np.isclose(found.negative, 1 / 5)
    assert np.allclose(found.explained, 0.5)


def test_points_are_those_of_scikit_learn():
    """City block distances of six points; ClassicalMDS(metric="precomputed") of scikit-learn 1.9.1, signs and all."""
    x = np.array([[0, 1, 2], [3, 1, 0], [2, 2, 5], [1, 0, 1], [4, 4, 1], [0, 5, 3]], float)
    theirs = [
        [0.71721803, -2.67475542],
        [-4.42008532, 0.07297353],
        [1.48123489, -1.44996809],
        [-2.02946887, -1.93105568],
        [-1.11029294, 4.88381483],
        [5.36139421, 1.09899083],
    ]
    assert np.allclose(mds(np.abs(x[:, None] - x).sum(axis=-1)).points, theirs, atol=1e-8)


def test_two_samples_are_scaled_together():
    x, y = np.random.default_rng(2).normal(size=(2, 9, 2)) + np.array([0.0, 5.0])[:, None, None]
    a, b, whole = mds_of_two(*parts(x, y))
    assert np.allclose(plain_distances(a, b), plain_distances(x, y)) and len(whole.points) == 18


def test_copies_of_one_item_lie_on_one_point():
    assert np.array_equal(mds(np.zeros((3, 3))).points, np.zeros((3, 2)))


@pytest.mark.parametrize(
    ("distances", "n_dims", "words"),
    [(np.zeros((2, 3)), 1, "symmetric"), (np.triu(np.ones((3, 3))), 1, "symmetric"), (np.zeros((3, 3)), 4, "1 to 3")],
)
def test_what_is_no_matrix_of_distances_is_refused(distances, n_dims, words):
    with pytest.raises(ValueError, match=words):
        mds(distances, n_dims)
