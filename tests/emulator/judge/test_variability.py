import numpy as np
import pytest

from emulator.judge.canonical_postures import variability


def test_a_case_by_hand():
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
