"""Intervals of mean squares: what defines them, and of means over people and days."""

import numpy as np
import pytest
from scipy.special import fdtri

from opsim.study.intervals import t_interval
from opsim.study.labour.variance_components import (
    MeanSquare,
    difference_interval,
    mean_interval,
    squares_of,
    sum_interval,
)
from tests.opsim.study.labour.test_parts import made


@pytest.mark.parametrize(("df1", "df2"), [(9, 20), (39, 117), (3, 4)])
def test_a_difference_touches_zero_where_the_f_test_does(df1, df2):
    just = fdtri(df1, df2, 0.975)
    assert difference_interval(MeanSquare(just, df1), MeanSquare(1.0, df2))[0] == pytest.approx(0, abs=1e-9)
    just = fdtri(df1, df2, 0.025)
    assert difference_interval(MeanSquare(just, df1), MeanSquare(1.0, df2))[1] == pytest.approx(0, abs=1e-9)


def test_a_difference_from_next_to_nothing_is_the_chi_square_interval():
    low, high = difference_interval(MeanSquare(2.0, 12), MeanSquare(1e-12, 30))
    assert (low, high) == pytest.approx(sum_interval([(1.0, MeanSquare(2.0, 12))]), rel=1e-6)


def test_squares_add_up_to_the_sum_of_squares():
    table = np.random.default_rng(3).normal(size=(6, 4))
    found = squares_of(table, True)
    total = 5 * found.rows.value + found.columns.value * 3 + found.rest.value * 15
    assert total == pytest.approx(np.sum((table - table.mean()) ** 2))


def test_tails_longer_than_normal_cost_degrees_of_freedom():
    few_odd = np.tile(np.r_[np.zeros(19), 10.0][:, None], (1, 3))
    assert squares_of(few_odd, True).rows.df < 3
    assert squares_of(np.tile(np.arange(20.0)[:, None], (1, 3)), True).rows.df == 19


def test_nested_means_are_student_t_of_the_rows():
    table = np.arange(12.0).reshape(6, 2)
    by_rows = t_interval(table.mean(axis=1))
    found = mean_interval(table, crossed=False)
    assert (found.mean, found.half_width) == pytest.approx((by_rows.mean, by_rows.half_width))


@pytest.mark.parametrize(("shape", "staffing", "day", "interaction"), [
    ((40, 4), 1.0, 0.3, 0.3), ((40, 4), 0.2, 1.0, 0.3), ((10, 5), 1.0, 1.0, 1.0), ((20, 3), 0.0, 0.0, 1.0),
])  # fmt: skip
def test_the_mean_is_held_as_often_as_is_said(shape, staffing, day, interaction):
    rng, n = np.random.default_rng(8), 500
    hits = 0
    for _ in range(n):
        found = mean_interval(made(rng, shape, staffing, day, interaction), crossed=True)
        hits += found.low <= 60 <= found.high
    assert hits / n > 0.95 - 3 * (0.95 * 0.05 / n) ** 0.5


def test_what_never_varies_is_known():
    assert mean_interval(np.full((4, 3), 7.0), crossed=True).half_width == 0
