import numpy as np
import pytest
from scipy.special import ndtri

from emulator.model.joint_coordinates import (
    Margin,
    bits,
    decode,
    encode,
    fit_margin,
    inverse_all,
    on_grid,
    within_worker,
)


def test_the_mean_of_a_lognormal_margin_is_the_formula():
    margin = Margin(np.zeros(1), np.array([np.log(20.0)]), 0.3)
    assert np.isclose(margin.mean_duration_s(0.5, 0.8), 20 * np.exp(0.15 + 0.24**2 / 2), rtol=1e-10)
    assert np.isclose(margin.cv(0.5, 0.8), np.sqrt(np.expm1(0.24**2)), rtol=1e-8)


def test_normal_values_keep_a_straight_margin():
    values = np.random.default_rng(0).normal(1.0, 0.2, 60)
    margin = fit_margin(values, values, 12)
    assert margin.name == "normal"
    assert np.isclose(margin.forward(np.array(values.mean())), 0)


def test_skewed_values_get_normal_scores_that_go_both_ways():
    values = np.random.default_rng(0).exponential(1.0, 60)
    margin = fit_margin(values, values, 30)
    z = np.linspace(-5, 5, 101)
    assert margin.name == "normal scores"
    assert np.all(np.diff(margin.inverse(z)) > 0)
    assert np.allclose(margin.forward(margin.inverse(z)), z, atol=1e-8)


def test_normal_scores_of_two_lumps_leave_the_gap_nearly_empty():
    rng = np.random.default_rng(1)
    values = np.concatenate([rng.normal(0.35, 0.01, 40), rng.normal(0.68, 0.01, 20)])
    drawn = fit_margin(values, values, 60, 0.05).inverse(rng.standard_normal(20_000))
    assert np.mean((drawn > 0.42) & (drawn < 0.62)) < 0.03


def test_ties_do_not_break_the_way_back():
    values = np.repeat([0.1, 0.2, 5.0], 10)
    margin = fit_margin(values, values, 40)
    assert margin.name == "normal scores"
    assert np.all(np.diff(margin.value) > 0)


def test_equal_durations_have_a_margin():
    margin = fit_margin(np.full(30, 0.7), np.zeros(30), 12)
    assert np.isclose(margin.mean_duration_s(0.0, 1.0), np.exp(0.7))


def test_residuals_have_no_mean_left_by_worker():
    index = np.array([0, 1, 0, 2, 1, 0])
    left = within_worker(np.arange(12.0).reshape(6, 2), index)
    assert all(np.allclose(left[index == w].mean(0), 0) for w in range(3))


def test_no_margins_take_no_columns():
    assert inverse_all((), np.empty((4, 0))).shape == (4, 0)


def test_the_closed_form_of_a_normal_margin_is_what_its_grid_gives():
    closed, by_grid = (
        Margin(np.zeros(1), np.array([0.3]), 0.7),
        Margin(np.array([-1.0, 1.0]), np.array([-0.4, 1.0]), 0.7),
    )
    mean, spread = np.array([-0.5, 0.0, 1.2]), np.array([0.0, 0.4, 1.1])
    assert np.allclose(closed.moments_s(mean, spread), by_grid.moments_s(mean, spread), rtol=1e-9)


def rows():
    return np.random.default_rng(0).normal(size=(5, 300)) * np.array([[1e-9], [1.0], [3e4], [0.5], [0.0]])


@pytest.mark.parametrize("n_bits", [15, 19, 24])
def test_rounding_to_the_grid_twice_is_rounding_once(n_bits):
    once = on_grid(rows(), n_bits)
    assert np.array_equal(on_grid(once, n_bits), once)


@pytest.mark.parametrize("n_bits", [15, 19, 24])
def test_the_grid_is_as_fine_as_its_bits(n_bits):
    largest = np.abs(rows()).max(axis=1, keepdims=True)
    assert np.all(np.abs(on_grid(rows(), n_bits) - rows()) <= largest * 2.0**-n_bits * 1.01)


@pytest.mark.parametrize(("n_bits", "kind"), [(15, np.int16), (19, np.int32)])
def test_encoded_rows_come_back_exactly(n_bits, kind):
    grid = on_grid(rows(), n_bits)
    whole, exponent = encode(grid, n_bits)
    assert whole.dtype == kind
    assert np.array_equal(decode(whole, exponent), grid)


def test_more_points_get_more_bits_as_their_second_differences_need():
    assert [bits(n) for n in (10, 101, 201, 301, 10**6)] == [15, 15, 17, 19, 30]


def test_the_grid_does_not_show_in_the_second_differences_of_many_points():
    clock = np.linspace(0, 1, 301)
    smooth = np.sin(2 * np.pi * clock)[None]
    bent = [np.diff(x, n=2).std() for x in (smooth, on_grid(smooth, bits(301)) - smooth, on_grid(smooth, 15) - smooth)]
    assert bent[1] < 0.03 * bent[0] < bent[2]


def test_normal_scores_are_bloms():
    """Blom 1958: the i-th of n values is the normal quantile of (i - 3/8) / (n + 1/4)."""
    values = np.repeat([0.0, 1.0, 5.0], 5) + 1e-3 * np.arange(15)
    found = fit_margin(values, values, 20)
    assert np.allclose(found.z, ndtri((np.arange(1, 16) - 0.375) / 15.25), atol=1e-12)
