import numpy as np
import pytest

from opsim.study.intervals import holm, paired, paired_with_each


def made(seed):
    """Figures of 40 variants, 2 figures each, in 6 to 14 replications: some alike, some unknown, some constant."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(6, 15))
    base = rng.normal(100, 5, (2, n))
    values = base + rng.normal(0, 1, (40, 2, n)) + rng.normal(0, 1, (40, 2, 1))
    values[3] = base
    values[4] = base * (1 + 1e-14)
    values[5] = base + 2
    values[6, 0], values[7] = 7.0, np.nan
    values[8, :, ::2] = np.nan
    values[9, 1, 1:] = np.nan
    return (base if seed % 2 else np.full_like(base, 9.0)), values


@pytest.mark.parametrize("seed", range(6))
def test_one_with_each_is_one_by_one(seed):
    one, others = made(seed)
    mean, p, same = paired_with_each(one, others)
    for i, other in enumerate(others):
        for figure in (0, 1):
            interval, alone, _ = paired(one[figure], other[figure])
            assert mean[i, figure] == pytest.approx(interval.mean, rel=1e-9, abs=1e-12, nan_ok=True)
            assert p[i, figure] == pytest.approx(alone, rel=1e-6, abs=1e-12, nan_ok=True)
            assert same[i, figure] == (interval.n > 0 and interval.mean == 0 and interval.sd == 0)


def test_none_to_compare_with_is_nothing():
    mean, p, same = paired_with_each(np.ones((2, 5)), np.ones((0, 2, 5)))
    assert mean.shape == p.shape == same.shape == (0, 2) and holm([]).size == 0
