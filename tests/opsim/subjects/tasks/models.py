"""One of every time model, each with the mean 20 s, and the cv it was asked for (or has by formula)."""

from math import sqrt

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
    Recorded,
    Triangular,
    Uniform,
    Weibull,
)

CV_OF = {
    Fixed(20.0): 0.0,
    Exponential(20.0): 1.0,
    Erlang(20.0, 4): 0.5,
    Geometric(20.0, 5.0): sqrt(0.75),
    Uniform(15.0, 25.0): 10 / sqrt(12) / 20,
    Triangular(10.0, 20.0, 30.0): sqrt(100 / 6) / 20,
    Triangular(0.0, 0.0, 60.0): 60 / sqrt(18) / 20,
    Lognormal(20.0, 0.3): 0.3,
    Lognormal(20.0, 0.3, 0.5): 0.3,
    Lognormal(20.0, 0.3, 1.0): 0.3,
    Gamma(20.0, 0.3): 0.3,
    Gamma(20.0, 0.3, 0.5): 0.3,
    Gamma(20.0, 0.3, 1.0): 0.3,
    Gamma(20.0, 2.0): 2.0,
    Weibull(20.0, 0.3): 0.3,
    Weibull(20.0, 1.5): 1.5,
    Weibull(20.0, 0.3, 0.5): 0.3,
    Hyperexponential(20.0, 1.0): 1.0,
    Hyperexponential(20.0, 2.0): 2.0,
    Hyperexponential(20.0, 2.0, 0.3): 2.0,
    Normal(20.0, 0.1): 0.1,
    Normal(20.0, 0.8): 0.8,
    Normal(20.0, 0.2, 0.0, 15.0): 0.2,
    Normal(20.0, 0.3, 0.5): 0.3,
    Beta(20.0, 0.2, 0.0, 10.0, 40.0): 0.2,
    Beta(20.0, 0.6, 0.0, 5.0, 60.0): 0.6,
    Beta(20.0, 0.3, 0.5, 5.0, 60.0): 0.3,
    Recorded((10.0, 20.0, 30.0)): sqrt(200 / 3) / 20,
    Empirical((10.0, 20.0, 30.0)): sqrt(200 / 3 - 200 / 18) / 20,
}
MODELS = list(CV_OF)
SHARED = [model for model in MODELS if getattr(model, "between_share", 0)]
