import numpy as np
import pytest
from scipy import stats

from opsim.fitting import FAMILIES, _judged, fitted, ks_distance
from opsim.tasks import Erlang, Exponential, Lognormal, Weibull


def times(model, n=400, seed=3):
    return model.sample(n, np.random.default_rng(seed)).duration_s


@pytest.mark.parametrize(
    ("model", "name"),
    [(Lognormal(20.0, 0.5), "lognormal"), (Weibull(20.0, 0.3), "weibull"), (Exponential(20.0), "exponential")],
)
def test_the_family_behind_the_times_comes_first_and_fits(model, name):
    best = fitted(times(model))[0]
    assert best.dist == name and best.p > 0.05


def test_what_is_no_family_fits_badly():
    two_kinds = np.r_[times(Erlang(10.0, 100), 150), times(Erlang(30.0, 100), 150)]
    assert max(one.p for one in fitted(two_kinds)) < 0.05


def test_the_same_times_get_the_same_answer():
    assert fitted(times(Lognormal(20.0, 0.5), 50)) == fitted(times(Lognormal(20.0, 0.5), 50))


def test_the_line_for_a_scenario_is_what_the_scenario_reads():
    said = {one.dist: one.said for one in fitted(times(Lognormal(20.0, 0.5)))}
    assert said["lognormal"].startswith("dist: lognormal, mean: ") and ", cv: 0." in said["lognormal"]
    assert "k: " in said["erlang"] and "cv" not in said["exponential"]


def test_the_distance_is_that_of_kolmogorov_and_smirnov():
    x = np.sort(times(Exponential(20.0), 50))
    cdf = 1 - np.exp(-x / 15)
    assert ks_distance(cdf) == pytest.approx(stats.kstest(x, stats.expon(scale=15).cdf).statistic, rel=1e-12)


@pytest.mark.parametrize(
    ("given", "said"),
    [([1.0] * 7, "7 times are too few"), ([3.0] * 20, "all times are the same; write 'fixed: 3 s'")],
)
def test_times_that_cannot_be_fitted_are_refused(given, said):
    with pytest.raises(ValueError, match=said):
        fitted(np.array(given))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["lognormal", "gamma"])
def test_a_right_family_is_called_poor_one_time_in_twenty(name):
    """Of 300 samples of 40 times the share with p < 0.05 lies within four standard errors of 0.05."""
    family = next(one for one in FAMILIES if one.name == name)
    model = family.fit(times(Lognormal(20.0, 0.4)))
    samples = [times(model, 40, seed) for seed in range(300)]
    poor = np.mean([_judged(family, family.fit(x), x, seed).p <= 0.05 for seed, x in enumerate(samples)])
    assert abs(poor - 0.05) < 4 * (0.05 * 0.95 / 300) ** 0.5
