import numpy as np
import pytest

from emulator.judge import novelty
from emulator.judge.sequence_distances import distances, distances_numpy, mds, mds_of_two, stream
from tests.emulator.judge.made import parts, plain_distances, sequences


def turned(angle_rad):
    """A sequence of two bones, one of which is turned by the angle against the other sequence's."""
    x = np.tile([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], (3, 1, 1))
    y = x.copy()
    y[:, 0] = [np.sin(angle_rad), 0.0, np.cos(angle_rad)]
    return np.stack([x, y])


@pytest.mark.parametrize("angle_rad", [0.0, 1e-5, 0.01, 0.5, np.pi / 2 - 1e-3, np.pi / 2, 2.0, 3.0])
def test_one_bone_turned_is_that_angle_away(angle_rad):
    assert np.isclose(distances(turned(angle_rad))[0, 1], angle_rad, rtol=1e-6, atol=3e-8)


def test_opposite_bones_are_half_a_turn_apart():
    assert np.isclose(distances(turned(np.pi))[0, 1], np.pi, atol=1e-3)


@pytest.mark.parametrize("spread", [0.001, 0.1, 1.0])
def test_the_kernel_is_its_twin(spread):
    x, y = sequences(9, 60, 20, spread), sequences(70, 60, 20, spread, seed=1)
    assert np.allclose(distances(x, y), distances_numpy(x, y), rtol=1e-6, atol=0)
    off = ~np.eye(70, dtype=bool)
    assert np.allclose(distances(y)[off], distances_numpy(y)[off], rtol=1e-6 if spread > 0.01 else 1e-5, atol=0)


def test_distances_are_a_metric():
    d = distances(sequences())
    assert np.array_equal(d, d.T) and np.all(np.diag(d) == 0)
    assert np.all(d[:, :, None] <= d[:, None, :] + d[None, :, :] + 1e-6)


def test_the_order_of_the_sequences_and_threads_change_nothing():
    x = sequences(130)
    order = np.random.default_rng(0).permutation(len(x))
    assert np.allclose(distances(x)[np.ix_(order, order)], distances(x[order]), atol=1e-6)
    assert np.array_equal(distances(x), distances(x, n_threads=2))


@pytest.mark.parametrize(
    ("broken", "words"),
    [(lambda x: x[0], "expected"), (lambda x: x[:, :, :2], "alike"), (lambda x: x * np.nan, "not finite")],
)
def test_what_is_no_set_of_sequences_is_refused(broken, words):
    with pytest.raises(ValueError, match=words):
        distances(sequences(), broken(sequences()))


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


def numbers(*name):
    return stream(*name).random(5)


def test_a_name_has_its_numbers_and_no_other_name_has_them():
    given = numbers(7, "deep_squat", "PWI")
    assert np.array_equal(given, numbers(7, "deep_squat", "PWI"))
    others = [(8, "deep_squat", "PWI"), (7, "deep_squat"), (7, "PWI", "deep_squat"), (7, "deep_squatPWI")]
    assert not any(np.any(given == numbers(*other)) for other in others)


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
