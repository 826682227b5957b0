"""Whole numbers by the seam of times."""

import numpy as np
import pytest

from opsim.scenario.schema import GeometricCycles, UniformCycles
from opsim.tasks import Fixed, Geometric
from opsim.tasks.model import UniformCount, count_model


def test_a_number_of_cycles_gets_the_model_it_says():
    assert count_model(500) == Fixed(500.0)
    assert count_model(GeometricCycles(dist="geometric", mean=20.0)) == Geometric(20.0, 1.0)
    assert count_model(UniformCycles(dist="uniform", low=4, high=6)) == UniformCount(4, 6)


def test_a_uniform_count_is_whole_and_takes_both_of_its_bounds():
    counts = UniformCount(4, 6).sample(30_000, np.random.default_rng(1)).duration_s
    values, seen = np.unique(counts, return_counts=True)
    assert values.tolist() == [4, 5, 6]
    assert np.all(np.abs(seen - 10_000) < 4 * (30_000 * 2 / 9) ** 0.5)
    assert UniformCount(4, 6).mean_duration_s() == 5


@pytest.mark.parametrize(("low", "high"), [(0, 3), (5, 4)])
def test_counts_begin_at_1_and_in_order(low, high):
    with pytest.raises(ValueError, match="must be 1 <= low <= high"):
        UniformCount(low, high)
