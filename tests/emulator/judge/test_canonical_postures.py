from time import process_time

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.judge.canonical_postures import (
    Quantization,
    nearest,
    sampled_postures,
    transition_distance,
    transition_matrices,
    uniform_transitions,
    variability,
)
from emulator.judge.sequence_distances import distances


def blobs(n_each=(200, 150, 100, 50), spread=0.05, seed=0, n_bones=5):
    """Postures (S, B, 3) about a few centres, and the number of each one's centre; the centres do not change."""
    centres = sphere.normalise(np.random.default_rng(99).normal(size=(len(n_each), n_bones, 3)))
    rng = np.random.default_rng(seed)
    owner = np.repeat(np.arange(len(n_each)), n_each)
    return sphere.normalise(centres[owner] + spread * rng.normal(size=(len(owner), n_bones, 3))), owner, centres


def path(n=3000, seed=0, n_bones=6):
    """Postures of a movement that rests at both ends and in the middle: no gaps between its modes."""
    rng = np.random.default_rng(seed)
    turn = np.array([0.0, 1.2, 2.4])[rng.integers(0, 3, n)] + 0.25 * rng.normal(size=n)
    angle = turn[:, None] * np.linspace(0.4, 1.0, n_bones) + 0.05 * rng.normal(size=(n, n_bones))
    return np.stack([np.sin(angle), 0.1 * rng.normal(size=angle.shape), np.cos(angle)], axis=-1)


def unit(x):
    return sphere.normalise(x)


def rand_index(a, b):
    """Adjusted Rand index (Hubert & Arabie 1985): 1 for the same division, around 0 for independent ones."""

    def pairs(x):
        return (x * (x - 1) / 2).sum()

    table = np.zeros((a.max() + 1, b.max() + 1))
    np.add.at(table, (a, b), 1)
    expected = pairs(table.sum(0)) * pairs(table.sum(1)) / pairs(np.array([len(a)]))
    return (pairs(table) - expected) / ((pairs(table.sum(0)) + pairs(table.sum(1))) / 2 - expected)


def test_the_index_by_which_divisions_are_compared_is_that_of_scikit_learn():
    """adjusted_rand_score of scikit-learn 1.9.1."""
    rng = np.random.default_rng(7)
    a = rng.integers(0, 4, 50)
    b = np.where(rng.random(50) < 0.7, a, rng.integers(0, 3, 50))
    assert np.isclose(rand_index(a, b), 0.6888798586444232, rtol=1e-12)


def test_as_many_canonical_postures_are_found_as_there_are_kinds():
    postures, owner, centres = blobs()
    found = Quantization.fit(postures)
    assert found.n_postures == 4  # as MeanShift(bandwidth=1.0) of scikit-learn 1.9.1, with the same members
    assert np.array_equal(found.sample_labels, owner)
    assert distances(found.canonical[:, None], centres[:, None]).diagonal().max() < 0.1


@pytest.mark.parametrize("n_kinds", [1, 2, 7])
def test_the_number_follows_the_data(n_kinds):
    assert Quantization.fit(blobs((120,) * n_kinds)[0]).n_postures == n_kinds


@pytest.mark.parametrize("n_bones", [3, 20])
def test_one_cloud_of_many_dimensions_is_one_kind(n_bones):
    """All are about equally far from one another there: without ``CROWD``, each was a mode of its own."""
    assert Quantization.fit(blobs((600,), n_bones=n_bones)[0]).n_postures == 1


def test_a_canonical_posture_is_the_mean_of_its_cluster():
    postures, owner, _ = blobs()
    means = np.stack([sphere.mean(postures[owner == k]) for k in range(4)])
    assert np.allclose(Quantization.fit(postures).canonical, means, atol=1e-9)


def test_the_order_of_the_sample_changes_no_bit():
    postures = unit(path(1500))
    order = np.random.default_rng(3).permutation(len(postures))
    one, other = Quantization.fit(postures), Quantization.fit(postures[order])
    assert np.array_equal(one.canonical, other.canonical)
    assert np.array_equal(one.sample_labels[order], other.sample_labels)


def test_turning_the_whole_body_turns_the_canonical_postures():
    postures = unit(path(1500))
    turn = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    one, other = Quantization.fit(postures), Quantization.fit(postures @ turn)
    assert np.allclose(one.canonical @ turn, other.canonical, atol=1e-9)
    assert np.array_equal(one.sample_labels, other.sample_labels)


def test_another_sample_of_the_same_movement_divides_it_alike():
    unseen = unit(path(1000, seed=50))
    found = [Quantization.fit(unit(path(1500, seed=seed))) for seed in range(3)]
    assert {q.n_postures for q in found} == {3}
    labels = [q.labels(unseen) for q in found]
    assert min(rand_index(labels[0], other) for other in labels[1:]) > 0.95


def test_few_odd_postures_are_no_kind_of_their_own():
    postures, _, _ = blobs((300, 200, 2))
    assert Quantization.fit(postures).n_postures == 2


def test_copies_of_one_posture_are_one_kind():
    postures = np.repeat(blobs()[0][:1], 30, axis=0)
    found = Quantization.fit(postures)
    assert found.n_postures == 1 and np.allclose(found.canonical[0], postures[0])
    assert Quantization.fit(postures[:1]).n_postures == 1


def test_every_posture_of_a_sequence_gets_its_nearest():
    canonical = blobs()[2]
    sequences = canonical[np.array([[0, 0, 1], [2, 3, 3]])]
    assert nearest(sequences, canonical).tolist() == [[0, 0, 1], [2, 3, 3]]
    assert Quantization.fit(blobs()[0]).labels(sequences).tolist() == [[0, 0, 1], [2, 3, 3]]


def test_sorted_distances_have_small_blocks_on_the_diagonal():
    found = Quantization.fit(blobs()[0])
    apart, labels = found.sorted_distances, np.sort(found.sample_labels)
    same = labels[:, None] == labels
    assert apart[same].max() < apart[~same].min()


def test_a_sample_is_without_replacement_and_all_where_there_are_fewer():
    sequences = blobs()[0].reshape(10, 50, 5, 3)
    drawn = sampled_postures(sequences, 60, np.random.default_rng(0))
    assert len(np.unique(drawn.reshape(60, -1), axis=0)) == 60
    assert sampled_postures(sequences, 5000, np.random.default_rng(0)).shape == (500, 5, 3)


def test_the_way_uphill_is_its_plain_twin():
    from emulator.kernels.sphere import uphill

    rng = np.random.default_rng(5)
    x, density = rng.normal(size=(60, 2)), rng.integers(0, 9, 60).astype(float)
    apart = np.linalg.norm(x[:, None] - x, axis=-1)
    for i, found in enumerate(uphill(apart, density, 0.8)):
        higher = [j for j in range(60) if (-density[j], j) < (-density[i], i) and apart[i, j] < 0.8]
        assert found == (min(higher, key=lambda j: (apart[i, j], j)) if higher else i)


def test_what_is_no_set_of_postures_is_refused():
    with pytest.raises(ValueError, match="expected postures"):
        Quantization.fit(np.zeros((0, 4, 3)))


@pytest.mark.slow
def test_recorded_classes_are_divided_alike_by_two_samples():
    from emulator.geometry.alignment import align
    from emulator.recordings import read_motions
    from tests.recordings import recording

    motions = read_motions(recording("uiprmd_deep_squat"), where="cov_correct == 1")
    aligned = align([m.directions for m in motions.motions], n_times=301, max_iterations=3).directions
    fits = [Quantization.fit(sampled_postures(aligned, 5000, np.random.default_rng(seed))) for seed in range(3)]
    labels = [q.labels(aligned).ravel() for q in fits]
    assert all(abs(q.n_postures - fits[0].n_postures) <= 1 for q in fits)
    assert min(rand_index(labels[0], labels[1]), rand_index(labels[0], labels[2])) > 0.85


@pytest.mark.slow
def test_five_thousand_postures_take_less_than_twenty_times_their_distances():
    postures = unit(path(5000, n_bones=20))

    def seconds(work):
        start = process_time()
        work()
        return process_time() - start

    Quantization.fit(postures[:100])
    matrix_s = min(seconds(lambda: distances(postures[:, None])) for _ in range(2))
    whole_s = min(seconds(lambda: Quantization.fit(postures)) for _ in range(2))
    assert whole_s < 20 * matrix_s


def test_a_case_by_hand():
    """0 0 1 1 1 and 0 1 1 0 1, all in one window: from 0 once to 0 and three times to 1, from 1 once to 0."""
    found = transition_matrices(np.array([[0, 0, 1, 1, 1], [0, 1, 1, 0, 1]]), 3, window=4)
    assert np.allclose(found, [[[1 / 4, 3 / 4, 0], [1 / 4, 3 / 4, 0], [0, 0, 0]]])


def test_the_papers_windows_are_29_of_301_points():
    assert transition_matrices(np.zeros((2, 301), int), 9).shape == (29, 9, 9)
    assert transition_matrices(np.zeros((2, 301), int), 9, window=20, step=10).shape == (29, 9, 9)
    assert transition_matrices(np.zeros((2, 101), int), 9).shape[0] == 32


def plain(labels, n_postures, window, step):
    """The paper's sums as they are written."""
    matrices = []
    for start in range(0, labels.shape[1] - window, step):
        counts = np.zeros((n_postures, n_postures))
        for sequence in labels:
            for s in range(start, start + window):
                counts[sequence[s], sequence[s + 1]] += 1
        visits = counts.sum(axis=1)
        matrices.append([row / n if n else 0 * row for row, n in zip(counts, visits)])
    return np.array(matrices)


def test_the_sums_are_those_of_the_definition_and_rows_sum_to_one_where_a_posture_occurs():
    labels = np.random.default_rng(0).integers(0, 4, (7, 61))
    found = transition_matrices(labels, 5, 12, 5)
    assert np.allclose(found, plain(labels, 5, 12, 5))
    assert np.allclose(found[:, :4].sum(axis=-1), 1) and np.all(found[:, 4] == 0)


def test_uniform_labels_are_near_the_uniform_baseline():
    labels = np.random.default_rng(1).integers(0, 4, (20_000, 61))
    found = transition_matrices(labels, 4, 20, 10)
    baseline = uniform_transitions(len(found), 4)
    assert np.allclose(baseline.sum(axis=-1), 1)
    assert transition_distance(found, baseline) < 0.01 * found.size


def test_a_posture_that_is_never_left_is_as_far_from_the_baseline_as_can_be():
    """1 on one diagonal place, 0 on K - 1 rows: 2 (1 - 1/K) and K - 1 a window."""
    found = transition_matrices(np.zeros((3, 31), int), 9)
    expected = len(found) * (2 * (1 - 1 / 9) + 8)
    assert np.isclose(transition_distance(found, uniform_transitions(len(found), 9)), expected)


def test_two_halves_of_one_law_come_nearer_with_more_sequences():
    def halves(n):
        steps = np.random.default_rng(2).random((2, n, 100)) < 0.1
        return transition_distance(*(transition_matrices(np.cumsum(half, axis=-1) % 3, 3) for half in steps))

    assert halves(2000) < 0.25 * halves(40)


@pytest.mark.parametrize(
    ("labels", "options", "words"),
    [([[0, 3]], {}, "0 to 2"), ([[0, -1]], {}, "0 to 2"), ([[0, 1]], {"window": 2}, "1 to 1")],
)
def test_what_does_not_fit_is_refused(labels, options, words):
    with pytest.raises(ValueError, match=words):
        transition_matrices(np.array(labels), 3, **options)


def test_families_of_unequal_shape_have_no_distance():
    with pytest.raises(ValueError, match="one shape"):
        transition_distance(uniform_transitions(2, 3), uniform_transitions(3, 3))


def test_a_case_of_variability_by_hand():
    """Of four points none, one and two differ: E = 1/4, Var E = 1/16."""
    found = variability(np.array([[0, 0, 1, 1], [0, 1, 1, 1], [1, 0, 0, 1]]), np.array([0, 0, 1, 1]))
    assert found.each.tolist() == [0, 0.25, 0.5] and found.mean == 0.25 and found.variance == 1 / 16


def test_renaming_the_postures_changes_nothing():
    rng = np.random.default_rng(0)
    labels, reference, names = rng.integers(0, 5, (8, 30)), rng.integers(0, 5, 30), rng.permutation(5)
    assert variability(names[labels], names[reference]).mean == variability(labels, reference).mean


def test_one_sequence_has_no_variance():
    assert np.isnan(variability(np.zeros((1, 3), int), np.zeros(3, int)).variance)


def test_unequal_lengths_are_refused():
    with pytest.raises(ValueError, match="equal lengths"):
        variability(np.zeros((2, 3), int), np.zeros(4, int))
