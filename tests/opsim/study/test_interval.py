import numpy as np
import pytest

from opsim.study.interval import t_interval


def test_the_textbook_interval():
    """Law, Simulation Modeling and Analysis, example 9.14: mean 2.03, half-width 0.32 at 90 %."""
    found = t_interval([1.53, 1.66, 1.24, 2.34, 2.00, 1.69, 2.69, 2.86, 1.70, 2.60], 0.90)
    assert found.mean == pytest.approx(2.031, abs=1e-9)
    assert found.half_width == pytest.approx(0.3222834049417794, abs=1e-9)


def test_one_value_has_no_interval_and_none_has_no_mean():
    assert t_interval([3.0]).mean == 3.0 and np.isnan(t_interval([3.0]).half_width)
    assert t_interval([]).n == 0 and np.isnan(t_interval([]).mean)


def test_unknown_values_are_left_out_and_show():
    assert t_interval([1.0, np.nan, 3.0]).n == 2
    assert t_interval([1.0, np.nan, 3.0]).mean == 2.0


def test_the_interval_covers_as_often_as_it_says():
    rng = np.random.default_rng(0)
    hits = sum(abs(i.mean) <= i.half_width for i in (t_interval(rng.normal(size=8)) for _ in range(4000)))
    assert abs(hits / 4000 - 0.95) < 4 * np.sqrt(0.95 * 0.05 / 4000)
