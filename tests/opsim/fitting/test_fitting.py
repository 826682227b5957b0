import numpy as np
import pytest
from scipy import stats

from opsim.fitting import FAMILIES, _judged, between_share, fitted, gamma_shape, ks_distance
from opsim.tasks import Erlang, Exponential, Gamma, Hyperexponential, Lognormal, Normal, Weibull

FAMILY = {family.name: family for family in FAMILIES}
TRUE = {
    "lognormal": Lognormal(20.0, 0.4),
    "gamma": Gamma(20.0, 0.6),
    "weibull": Weibull(20.0, 0.5),
    "normal": Normal(20.0, 0.3),
    "erlang": Erlang(20.0, 4),
    "exponential": Exponential(20.0),
    "hyperexponential": Hyperexponential(20.0, 2.0),
}


@pytest.mark.parametrize("name", TRUE)
def test_a_family_finds_itself(name):
    n = 20_000
    times = TRUE[name].sample(n, np.random.default_rng(6)).duration_s
    model = FAMILY[name].fit(times)
    cv = times.std() / times.mean()
    assert model.mean_duration_s() == pytest.approx(20.0, abs=4 * 20 * cv / n**0.5)
    if name == "erlang":
        assert model.k == 4
    elif name != "exponential":
        assert model.cv == pytest.approx(TRUE[name].cv, rel=0.05)


@pytest.mark.parametrize("name", TRUE)
def test_the_density_is_the_slope_of_the_distribution_function(name):
    x, step = np.linspace(1.0, 80.0, 300), 1e-5
    family, model = FAMILY[name], TRUE[name]
    slope = (family.cdf(model, x + step) - family.cdf(model, x - step)) / (2 * step)
    assert np.exp(family.log_density(model, x)) == pytest.approx(slope, rel=1e-4, abs=1e-9)


@pytest.mark.parametrize("name", TRUE)
def test_draws_have_the_distribution_function_of_their_family(name):
    times = TRUE[name].sample(20_000, np.random.default_rng(2)).duration_s
    assert stats.kstest(times, lambda x: FAMILY[name].cdf(TRUE[name], x)).pvalue > 1e-3


def test_shapes_are_those_of_greatest_likelihood():
    times = Gamma(20.0, 0.6).sample(400, np.random.default_rng(1)).duration_s
    assert gamma_shape(times) == pytest.approx(stats.gamma.fit(times, floc=0)[0], rel=1e-3)
    shape, _, scale = stats.weibull_min.fit(times, floc=0)
    model = FAMILY["weibull"].fit(times)
    assert model.mean_s == pytest.approx(stats.weibull_min(shape, scale=scale).mean(), rel=1e-3)
    assert model.cv == pytest.approx(stats.weibull_min(shape).std() / stats.weibull_min(shape).mean(), rel=1e-3)


def test_a_family_that_cannot_be_meant_is_left_out():
    wide = Hyperexponential(20.0, 2.0).sample(2000, np.random.default_rng(0)).duration_s
    narrow = Normal(20.0, 0.2).sample(2000, np.random.default_rng(0)).duration_s
    assert FAMILY["normal"].fit(wide) is None and FAMILY["erlang"].fit(wide) is None
    assert FAMILY["hyperexponential"].fit(narrow) is None


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


def test_known_answer():
    """Two workers, two times each: logs 0, 2 and 4, 6: MSW 2, MSB 16, between (16 - 2) / 2 = 7."""
    assert between_share(np.exp([0.0, 2.0, 4.0, 6.0]), ["a", "a", "b", "b"]) == pytest.approx(7 / 9)


def test_workers_who_are_alike_have_no_share():
    assert between_share(np.exp([0.0, 2.0, 0.0, 2.0]), ["a", "a", "b", "b"]) == 0.0


def test_the_share_that_was_put_in_is_found():
    model, rng = Lognormal(20.0, 0.4, 0.4), np.random.default_rng(2)
    n_of = rng.integers(5, 40, 300)
    times = [model.sample(n, rng, worker=model.draw_worker(rng)).duration_s for n in n_of]
    names = [f"w{worker}" for worker, n in enumerate(n_of) for _ in range(n)]
    assert between_share(np.concatenate(times), names) == pytest.approx(0.4, abs=0.1)


@pytest.mark.parametrize("names", [["a"] * 4, ["a", "b", "c", "d"]])
def test_what_cannot_be_told_is_said(names):
    with pytest.raises(ValueError, match="two workers at least"):
        between_share(np.arange(1.0, 5.0), names)
