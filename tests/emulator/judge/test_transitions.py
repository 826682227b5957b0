import numpy as np
import pytest

from emulator.judge.canonical_postures import transition_distance, transition_matrices, uniform_transitions


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
