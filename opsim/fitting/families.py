"""The families that are tried: each finds its parameters from times, and knows its density and distribution function.

Maximum likelihood where it is simple; the normal and the hyperexponential by mean and cv. Times are x (n,) seconds > 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import digamma, gammainc, gammaln, log_ndtr, ndtr, polygamma

from opsim.tasks import Erlang, Exponential, Gamma, Hyperexponential, Lognormal, Normal, Weibull
from opsim.tasks.shared import balanced_probability, weibull_shape


@dataclass(frozen=True)
class Family:
    """fit : times -> model, or None where the family cannot be meant; log_density and cdf : (model, times) -> (n,)"""

    name: str
    n_parameters: int
    fit: Callable[[np.ndarray], Any]
    log_density: Callable[[Any, np.ndarray], np.ndarray]
    cdf: Callable[[Any, np.ndarray], np.ndarray]


def _cv(x: np.ndarray) -> float:
    return float(x.std() / x.mean())


# --------------------------------------------------------------------------------------------------------- one by one
def _exponential_log_density(model: Exponential, x: np.ndarray) -> np.ndarray:
    return -math.log(model.mean_s) - x / model.mean_s


def _fit_lognormal(x: np.ndarray) -> Lognormal:
    logs = np.log(x)
    return Lognormal(float(np.exp(logs.mean() + logs.var() / 2)), math.sqrt(math.expm1(logs.var())))


def _standard_log(model: Lognormal, x: np.ndarray) -> np.ndarray:
    return (np.log(x) - math.log(model.mean_s) + model.log_variance / 2) / math.sqrt(model.log_variance)


def _lognormal_log_density(model: Lognormal, x: np.ndarray) -> np.ndarray:
    return -np.log(x) - 0.5 * math.log(2 * math.pi * model.log_variance) - _standard_log(model, x) ** 2 / 2


def gamma_shape(x: np.ndarray) -> float:
    """The shape k of greatest likelihood: ln k - psi(k) = ln mean x - mean ln x, by Newton from Minka's start."""
    s = math.log(x.mean()) - np.log(x).mean()
    k = (3 - s + math.sqrt((s - 3) ** 2 + 24 * s)) / (12 * s)
    for _ in range(20):
        k -= (math.log(k) - digamma(k) - s) / (1 / k - polygamma(1, k))
    return float(k)


def _gamma_log_density(model: Gamma | Erlang, x: np.ndarray) -> np.ndarray:
    k = _shape(model)
    rate = k / model.mean_s
    return k * math.log(rate) + (k - 1) * np.log(x) - rate * x - gammaln(k)


def _gamma_cdf(model: Gamma | Erlang, x: np.ndarray) -> np.ndarray:
    return gammainc(_shape(model), x * _shape(model) / model.mean_s)


def _shape(model: Gamma | Erlang) -> float:
    return float(model.k) if isinstance(model, Erlang) else model.cv**-2


def _fit_erlang(x: np.ndarray) -> Erlang | None:
    k = round(gamma_shape(x))
    return Erlang(float(x.mean()), k) if k > 1 else None


def _fit_weibull(x: np.ndarray) -> Weibull:
    """The shape k of greatest likelihood: sum x^k ln x / sum x^k - mean ln x = 1 / k, by bisection of ln k."""
    logs = np.log(x) - np.log(x).max()
    low, high = math.log(0.05), math.log(2000.0)
    for _ in range(60):
        k = math.exp((low + high) / 2)
        powers = np.exp(k * logs)
        too_small = (powers @ logs) / powers.sum() - logs.mean() < 1 / k
        low, high = (math.log(k), high) if too_small else (low, math.log(k))
    scale = float(np.exp(np.log(x).max()) * np.mean(np.exp(k * logs)) ** (1 / k))
    log_cv2 = math.lgamma(1 + 2 / k) - 2 * math.lgamma(1 + 1 / k)
    return Weibull(scale * math.gamma(1 + 1 / k), math.sqrt(math.expm1(log_cv2)))


def _weibull_scaled(model: Weibull, x: np.ndarray) -> tuple[float, np.ndarray]:
    k = weibull_shape(model.cv)
    return k, x * math.gamma(1 + 1 / k) / model.mean_s


def _weibull_log_density(model: Weibull, x: np.ndarray) -> np.ndarray:
    k, scaled = _weibull_scaled(model, x)
    return math.log(k) + k * np.log(scaled) - np.log(x) - scaled**k


def _weibull_cdf(model: Weibull, x: np.ndarray) -> np.ndarray:
    k, scaled = _weibull_scaled(model, x)
    return -np.expm1(-(scaled**k))


def _fit_normal(x: np.ndarray) -> Normal | None:
    return Normal(float(x.mean()), _cv(x)) if 0 < _cv(x) < 0.9 else None


def _normal_log_density(model: Normal, x: np.ndarray) -> np.ndarray:
    a, sigma_s = model._cut()
    return -((x / sigma_s + a) ** 2) / 2 - 0.5 * math.log(2 * math.pi) - math.log(sigma_s) - log_ndtr(-a)


def _normal_cdf(model: Normal, x: np.ndarray) -> np.ndarray:
    a, sigma_s = model._cut()
    return 1 - ndtr(-(x / sigma_s + a)) / ndtr(-a)


def _fit_hyperexponential(x: np.ndarray) -> Hyperexponential | None:
    return Hyperexponential(float(x.mean()), _cv(x)) if 1.05 < _cv(x) <= 10 else None


def _phases(model: Hyperexponential) -> tuple[np.ndarray, np.ndarray]:
    p = balanced_probability(model.cv)
    share = np.array([p, 1 - p])
    return share, model.mean_s / (2 * share)


def _hyperexponential_log_density(model: Hyperexponential, x: np.ndarray) -> np.ndarray:
    share, means_s = _phases(model)
    return np.log(np.exp(-x[:, None] / means_s) @ (share / means_s))


def _hyperexponential_cdf(model: Hyperexponential, x: np.ndarray) -> np.ndarray:
    share, means_s = _phases(model)
    return 1 - np.exp(-x[:, None] / means_s) @ share


FAMILIES = (
    Family("lognormal", 2, _fit_lognormal, _lognormal_log_density, lambda model, x: ndtr(_standard_log(model, x))),
    Family("gamma", 2, lambda x: Gamma(float(x.mean()), gamma_shape(x) ** -0.5), _gamma_log_density, _gamma_cdf),
    Family("weibull", 2, _fit_weibull, _weibull_log_density, _weibull_cdf),
    Family("normal", 2, _fit_normal, _normal_log_density, _normal_cdf),
    Family("erlang", 2, _fit_erlang, _gamma_log_density, _gamma_cdf),
    Family(
        "exponential",
        1,
        lambda x: Exponential(float(x.mean())),
        _exponential_log_density,
        lambda model, x: -np.expm1(-x / model.mean_s),
    ),
    Family("hyperexponential", 2, _fit_hyperexponential, _hyperexponential_log_density, _hyperexponential_cdf),
)
