import numpy as np
import pytest

from emulator.covariates.regression import Folds
from tests.emulator.covariates.cases import naive_left_out_r2, people

GROUPS = {
    "each row a person": np.arange(14),
    "people in another order": np.random.default_rng(1).permutation(14),
    "several rows a person": np.array([0, 0, 1, 1, 1, 2, 3, 4, 4, 5, 6, 6, 7, 7]),
}


@pytest.mark.parametrize("groups", GROUPS.values(), ids=GROUPS)
def test_r2_is_that_of_fits_without_each_person(groups):
    rng = np.random.default_rng(2)
    x, y = people(14, rng), rng.standard_normal((14, 5)) + 40.0
    y[:, 0] += 2 * x[:, 0]
    found = Folds.of(x, groups).r2(y, 3)
    for a in range(4):
        for k in range(5):
            assert found[a, k] == pytest.approx(naive_left_out_r2(x, y[:, k], groups, a), abs=1e-10)


def test_no_component_explains_nothing_and_a_true_line_everything():
    x = people(10, np.random.default_rng(3))
    found = Folds.of(x, np.arange(10)).r2(x @ np.array([[1.0], [2.0], [-1.0], [0.5]]), 4)
    assert found[0, 0] == 0
    assert found[4, 0] == pytest.approx(1.0, abs=1e-9)


def test_a_covariate_that_only_one_person_has_differently_says_nothing_of_him():
    x = np.zeros((6, 1))
    x[2] = 1.0
    y = np.random.default_rng(5).standard_normal((6, 3))
    _, slopes = Folds.of(x, np.arange(6)).slopes(y, 1)
    assert np.all(slopes[1, 2] == 0)
    assert np.all(np.isfinite(slopes))
