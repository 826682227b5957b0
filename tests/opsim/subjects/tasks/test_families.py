"""The parameters of each family, held against the formulas and distributions of scipy.

Whole numbers by the seam of times.

Parameters that are no times are refused where a model is made.
"""

import math

import numpy as np
import pytest
from scipy import stats

from opsim.scenario.schema import GeometricCycles, UniformCycles
from opsim.subjects.tasks.distributions import balanced_probability, count_model, normal_cut, weibull_shape
from opsim.subjects.tasks.model import UniformCount
from opsim.tasks import (
    Beta,
    Empirical,
    Erlang,
    Exponential,
    Fixed,
    Gamma,
    Geometric,
    Hyperexponential,
    Lognormal,
    Normal,
    Triangular,
    Uniform,
    Weibull,
)


@pytest.mark.parametrize("cv", [1e-3, 0.05, 0.3, 1.0, 3.0, 10.0])
def test_the_shape_of_a_weibull_gives_its_cv(cv):
    shape = weibull_shape(cv)
    mean, variance = stats.weibull_min(shape).stats()
    assert float(variance) ** 0.5 / float(mean) == pytest.approx(cv, rel=1e-6)


def test_a_weibull_of_cv_1_is_exponential():
    assert weibull_shape(1.0) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("ratio", [1.02, 1.25, 2.0, 5.0, 30.0, 60.0])
def test_the_cut_of_a_normal_gives_mean_and_spread_of_what_remains(ratio):
    a = normal_cut(ratio)
    mean, variance = stats.truncnorm(a, np.inf).stats()
    assert (float(mean) - a) / float(variance) ** 0.5 == pytest.approx(ratio, rel=1e-6)


@pytest.mark.parametrize("cv", [1.0, 1.5, 10.0])
def test_the_two_means_of_a_hyperexponential_are_balanced_and_give_its_cv(cv):
    p = balanced_probability(cv)
    means = np.array([1 / (2 * p), 1 / (2 * (1 - p))])
    second = 2 * (p * means[0] ** 2 + (1 - p) * means[1] ** 2)
    assert p * means[0] + (1 - p) * means[1] == pytest.approx(1.0, rel=1e-12)
    assert second - 1 == pytest.approx(cv**2, rel=1e-9)


H2 = Hyperexponential(20.0, 2.0)
P = balanced_probability(2.0)


@pytest.mark.parametrize(
    ("model", "cdf"),
    [
        (Erlang(20.0, 3), stats.gamma(3, scale=20 / 3).cdf),
        (Gamma(20.0, 0.5), stats.gamma(4, scale=5).cdf),
        (
            Weibull(20.0, 0.5),
            stats.weibull_min(weibull_shape(0.5), scale=20 / stats.weibull_min(weibull_shape(0.5)).mean()).cdf,
        ),
        (H2, lambda t: 1 - P * np.exp(-2 * P * t / 20) - (1 - P) * np.exp(-2 * (1 - P) * t / 20)),
        (Triangular(10.0, 15.0, 35.0), stats.triang(0.2, loc=10, scale=25).cdf),
        (
            Beta(20.0, 0.2, 0.0, 10.0, 40.0),
            stats.beta(*Beta(20.0, 0.2, 0.0, 10.0, 40.0)._shapes(), loc=10, scale=30).cdf,
        ),
    ],
    ids=lambda value: type(value).__name__,
)
def test_draws_follow_the_family(model, cdf):
    times = model.sample(20_000, np.random.default_rng(4)).duration_s
    assert stats.kstest(times, cdf).pvalue > 1e-3


def test_a_geometric_time_ends_after_each_step_with_the_same_chance():
    steps = Geometric(20.0, 4.0).sample(50_000, np.random.default_rng(4)).duration_s / 4.0
    assert np.array_equal(steps, np.rint(steps))
    for n in (1, 2, 3, 6):
        still = (steps >= n).sum()
        assert abs((steps == n).sum() - 0.2 * still) < 4 * (0.16 * still) ** 0.5


def test_draws_follow_the_normal_above_the_cut():
    model = Normal(20.0, 0.8)
    a, sigma_s = model._cut()
    times = model.sample(20_000, np.random.default_rng(4)).duration_s
    assert stats.kstest(times, stats.truncnorm(a, np.inf, loc=-a * sigma_s, scale=sigma_s).cdf).pvalue > 1e-3
    assert times.min() >= 2.0**-20


def test_a_normal_far_above_its_cut_is_a_normal():
    model = Normal(20.0, 0.01)
    times = model.sample(20_000, np.random.default_rng(4)).duration_s
    assert stats.kstest(times, stats.norm(20, 0.2).cdf).pvalue > 1e-3


@pytest.mark.parametrize("model", [Beta(20.0, 0.6, 0.0, 5.0, 60.0), Normal(20.0, 0.24, 0.0, 15.0)], ids=repr)
def test_bounds_are_kept(model):
    times = model.sample(100_000, np.random.default_rng(0)).duration_s
    assert times.min() >= model.low_s
    assert times.max() <= getattr(model, "high_s", np.inf)


def test_the_quantiles_of_an_empirical_time_are_linear_between_the_ordered_values():
    model = Empirical((30.0, 10.0, 20.0, 60.0))
    assert model.quantile_s(np.array([0, 0.125, 0.25, 0.375, 0.5, 0.875, 1])).tolist() == [10, 10, 15, 20, 25, 60, 60]


def test_an_empirical_time_has_exactly_the_mean_of_its_values_and_a_little_less_variance():
    values = tuple(np.random.default_rng(0).lognormal(3, 0.5, 40))
    model = Empirical(values)
    grid = (np.arange(400_000) + 0.5) / 400_000
    quantiles = model.quantile_s(grid)
    assert quantiles.mean() == pytest.approx(np.mean(values), rel=1e-7) == model.mean_duration_s()
    less = np.sum(np.diff(np.sort(values)) ** 2) / (6 * 40)
    assert quantiles.var() == pytest.approx(np.var(values) - less, rel=1e-6)
    assert less < 0.05 * np.var(values)


def test_two_equal_empirical_models_are_equal():
    assert Empirical((1.0, 2.0)) == Empirical((1.0, 2.0)) != Empirical((1.0, 3.0))


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


@pytest.mark.parametrize(
    "make",
    [
        lambda: Fixed(-5.0),
        lambda: Fixed(0.0),
        lambda: Exponential(math.nan),
        lambda: Exponential(math.inf),
        lambda: Lognormal(20.0, -0.2),
        lambda: Lognormal(-1.0, 0.2),
        lambda: Lognormal(20.0, 0.2, 1.5),
        lambda: Hyperexponential(0.0, 1.5),
        lambda: Erlang(5.0, 0),
        lambda: Geometric(5.0, 6.0),
        lambda: Uniform(-1.0, 2.0),
    ],
)
def test_an_impossible_parameter_is_refused(make):
    with pytest.raises(ValueError, match="must be"):
        make()


def test_a_text_is_no_time():
    with pytest.raises(TypeError, match="duration_s must be a time in seconds above 0, found '5'"):
        Fixed("5")
