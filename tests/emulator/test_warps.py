import numpy as np
import pytest
from scipy.interpolate import BSpline

from emulator.geometry import warps as warp
from emulator.geometry.warps import clock_to_coordinates, coordinates_to_clock
from tests.made import random_warp

RNG = np.random.default_rng(3)
CLOCK = np.linspace(0, 1, 101)
WARPS = np.array([random_warp(RNG, 101) for _ in range(30)])


def test_the_square_clock_halves_the_way_at_a_quarter():
    assert warp.evaluate(CLOCK**2, np.array([0.0, 0.5, 1.0])).tolist() == pytest.approx([0, 0.25, 1])
    assert np.allclose(warp.compose(CLOCK**2, CLOCK**2), CLOCK**4, atol=1e-4)


def test_a_warp_after_its_inverse_is_the_identity():
    fine = np.array([random_warp(RNG, 1001) for _ in range(10)])
    clock = np.linspace(0, 1, 1001)
    assert np.abs(warp.compose(fine, warp.invert(fine)) - clock).max() < 1e-4
    assert np.abs(warp.compose(warp.invert(fine), fine) - clock).max() < 1e-4


def test_evaluate_is_linear_interpolation():
    at = RNG.uniform(size=17)
    assert np.allclose(warp.evaluate(WARPS, at), [np.interp(at, CLOCK, gamma) for gamma in WARPS], atol=1e-15)


def test_clr_sums_to_zero_and_tells_the_slopes_of_a_smooth_warp():
    x = np.cos(np.pi * (np.arange(20) + 0.5) / 20) * RNG.normal(size=(40, 1))
    assert np.abs(warp.clr(warp.from_clr(x, 2001), 20) - x).max() < 0.02 * np.abs(x).max()
    assert np.abs(warp.clr(WARPS, 20).sum(-1)).max() < 1e-12


@pytest.mark.parametrize(("n_knots", "n_times"), [(20, 101), (20, 301), (15, 64), (5, 11), (2, 3), (10, 11)])
def test_from_clr_is_a_warp_whose_log_slope_is_scipys_spline(n_knots, n_times):
    x = RNG.normal(size=(50, n_knots))
    made = warp.from_clr(x, n_times)
    assert warp.check(made).shape == (50, n_times)
    held = np.concatenate([x[:, :1]] * 3 + [x] + [x[:, -1:]] * 3, axis=1)
    spline = BSpline(np.arange(n_knots + 10) - 5.0, held.T, 3)
    want = spline((np.arange(n_times - 1) + 0.5) / (n_times - 1) * n_knots - 0.5)
    got = np.log(np.diff(made))
    assert np.abs((got - got[:, :1]) - (want - want[:1]).T).max() < 1e-9


def test_control_points_through_slopes_give_them_back_in_the_middles():
    x = RNG.normal(size=(3, 20))
    slope = np.log(np.diff(warp.from_clr(warp.through(x), 20 * 9 + 1)))[:, 4::9]
    assert np.abs((slope - slope.mean(-1, keepdims=True)) - (x - x.mean(-1, keepdims=True))).max() < 1e-9


def test_neither_speed_nor_its_change_jumps():
    slope = np.diff(warp.from_clr(RNG.normal(size=20), 20 * 400 + 1)) * 20 * 400
    for _ in range(2):
        slope = np.diff(slope)
        assert np.abs(np.diff(slope)).max() < 0.02 * np.abs(slope).max()


@pytest.mark.parametrize("n_knots", [1, 2, 7, 20])
def test_a_few_moments_are_where_a_fine_clock_has_them(n_knots):
    rng = np.random.default_rng(n_knots)
    control, at = rng.normal(0, 0.5, (9, n_knots)), np.sort(rng.random((9, 6)), axis=1)
    at[:, 0], at[:, -1] = 0.0, 1.0
    share = warp.from_clr_at(control, at)
    assert np.abs(share - warp.evaluate(warp.from_clr(control, 20_001), at)).max() < 1e-6
    assert np.array_equal(share[:, 0], np.zeros(9)) and np.abs(share[:, -1] - 1).max() < 1e-12
    assert (np.diff(share, axis=1) > 0).all()
    assert np.abs(warp.from_clr_at(0 * control, at) - at).max() < 1e-12


def test_zero_coordinates_are_the_identity():
    assert np.allclose(warp.from_clr(np.zeros(15), 101), CLOCK, atol=1e-15)
    assert np.allclose(warp.clr(CLOCK, 15), 0, atol=1e-12)


def test_mean_of_one_warp_is_itself():
    assert np.abs(warp.mean(WARPS[:1]) - WARPS[0]).max() < 1e-10


def test_centred_warps_have_the_identity_as_their_mean():
    assert np.abs(warp.mean(WARPS) - CLOCK).max() > 1e-2
    assert np.abs(warp.mean(warp.centre(WARPS)) - CLOCK).max() < 5e-4


@pytest.mark.parametrize(
    ("gamma", "word"),
    [
        (np.array([0, 0.5, 0.4, 1.0]), "increase strictly"),
        (np.array([0.1, 0.5, 1.0]), "from 0 to 1"),
        (np.array([0, np.nan, 1.0]), "finite"),
    ],
)
def test_what_is_no_warp_is_refused(gamma, word):
    with pytest.raises(ValueError, match=word):
        warp.check(gamma)


def test_clr_refuses_a_standing_clock():
    with pytest.raises(ValueError, match="increase strictly"):
        warp.clr(np.concatenate([np.linspace(0, 1, 51), np.ones(50)]), 20)


def test_a_mark_in_the_middle_has_coordinate_zero():
    assert np.allclose(clock_to_coordinates(np.array([[0.5]])), 0)


def test_marks_come_back():
    clock = np.sort(np.random.default_rng(0).uniform(0.02, 0.98, (50, 3)), axis=1)
    clock = clock[np.diff(clock, axis=1).min(1) > 0.01]
    assert np.allclose(coordinates_to_clock(clock_to_coordinates(clock)), clock)


def test_any_coordinates_give_ordered_marks_inside_the_performance():
    clock = coordinates_to_clock(np.random.default_rng(1).normal(0, 8, (500, 4)))
    edges = np.concatenate([np.zeros((500, 1)), clock, np.ones((500, 1))], axis=1)
    assert np.all(np.diff(edges, axis=1) > 0)


def test_a_mark_on_the_very_end_has_a_finite_coordinate():
    assert np.all(np.isfinite(clock_to_coordinates(np.array([[0.0, 1.0]]))))


def test_a_task_without_marks_has_none():
    assert coordinates_to_clock(clock_to_coordinates(np.empty((5, 0)))).shape == (5, 0)
