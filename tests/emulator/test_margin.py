import numpy as np

from emulator.model.joint_coordinates import Margin, fit_margin, inverse_all, within_worker


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
