import numpy as np
import pytest
from scipy import stats

from opsim.fitting import FAMILIES, gamma_shape
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
