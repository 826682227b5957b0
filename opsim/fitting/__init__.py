"""The families that are tried: each finds its parameters from times, and knows its density and distribution function.

Maximum likelihood where it is simple; the normal and the hyperexponential by mean and cv. Times are x (n,) seconds > 0.

Which family, and does it fit? Akaike's criterion ranks; the Kolmogorov-Smirnov distance judges.

Parameters come from the same times, so the distance has no table: its p-value is found by a parametric bootstrap
(draw as many times from the fitted family, fit again, measure again), as Lilliefors (1967) did for two families.

How much of the spread lies between workers, from times with the name of who took them.

Recorded times -> a distribution of the scenario language, with how well it fits and how far workers differ.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import digamma, gammainc, gammaln, log_ndtr, ndtr, polygamma

from opsim.streams import stream
from opsim.subjects.tasks.distributions import balanced_probability, weibull_shape
from opsim.tasks import Erlang, Exponential, Gamma, Hyperexponential, Lognormal, Normal, Weibull

__all__ = ["Fitted", "between_share", "fitted"]


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


N_BOOTSTRAP = 199
FEWEST = 8
_MOST_IN_BOOTSTRAP = 2000


@dataclass(frozen=True)
class Fitted:
    """aic : Akaike's criterion, smaller is better; distance : the largest gap between the two distribution functions;
    p : how often as large a gap comes by chance, were the family right. ``said`` is the task as a scenario says it.
    """

    dist: str
    model: Any
    mean_s: float
    cv: float
    aic: float
    distance: float
    p: float

    @property
    def said(self) -> str:
        if self.dist == "erlang":
            return f"dist: erlang, mean: {self.mean_s:.4g} s, k: {self.model.k}"
        cv = "" if self.dist == "exponential" else f", cv: {max(self.cv, 0.001):.3g}"
        return f"dist: {self.dist}, mean: {self.mean_s:.4g} s{cv}"


def fitted(times_s: np.ndarray, *, seed: int = 0) -> list[Fitted]:
    """Every family that can be meant, the best first. Raises ValueError for fewer than 8 times or all the same."""
    x = np.asarray(times_s, dtype=float)
    if x.size < FEWEST:
        raise ValueError(f"{x.size} times are too few to choose a family; at least {FEWEST}")
    if np.ptp(x) < 1e-6 * x.mean():
        raise ValueError(f"all times are the same; write 'fixed: {x.mean():.4g} s'")
    found = [(family, model) for family in FAMILIES if (model := family.fit(x)) is not None]
    return sorted((_judged(family, model, x, seed) for family, model in found), key=lambda one: one.aic)


def _judged(family: Family, model: Any, x: np.ndarray, seed: int) -> Fitted:
    aic = 2 * family.n_parameters - 2 * float(family.log_density(model, x).sum())
    distance = ks_distance(family.cdf(model, np.sort(x)))
    p = _chance(family, model, min(x.size, _MOST_IN_BOOTSTRAP), distance * _scale(x.size), seed)
    return Fitted(family.name, model, model.mean_duration_s(), _cv_of(model), aic, distance, p)


def ks_distance(cdf: np.ndarray) -> float:
    """The largest gap between a distribution function at the ordered times and the steps of the empirical one."""
    steps = np.arange(cdf.size + 1) / cdf.size
    return float(max(np.max(steps[1:] - cdf), np.max(cdf - steps[:-1])))


def _chance(family: Family, model: Any, n: int, scaled: float, seed: int) -> float:
    """How often n times of the fitted family itself lie as far from what is fitted to them."""
    rng = stream(seed, 0, "fit", family.name, 0)
    distances = []
    for _ in range(N_BOOTSTRAP):
        drawn = np.sort(model.sample(n, rng).duration_s)
        again = family.fit(drawn)
        if again is not None:  # a sample the family refuses says nothing about how far others lie
            distances.append(ks_distance(family.cdf(again, drawn)) * _scale(n))
    return (1 + sum(distance >= scaled for distance in distances)) / (1 + len(distances)) if distances else 0.0


def _scale(n: int) -> float:
    """Makes distances of different numbers of times comparable (Stephens 1970)."""
    return n**0.5 + 0.12 + 0.11 / n**0.5


def _cv_of(model: Any) -> float:
    cv = getattr(model, "cv", None)
    return float(cv) if cv is not None else getattr(model, "k", 1) ** -0.5


def between_share(times_s: np.ndarray, workers: Sequence[str]) -> float:
    """The share of the variance of log time that lies between workers, by analysis of variance; 0 at least.

    With W workers of n_w times: within = MSW, between = (MSB - MSW) / n0, n0 = (N - sum n_w^2 / N) / (W - 1).
    Raises ValueError for fewer than two workers, or where nobody has two times.
    Source: Searle, Casella & McCulloch, Variance Components (1992), section 3.6.
    """
    logs, names = np.log(np.asarray(times_s, dtype=float)), np.asarray(workers)
    groups = [logs[names == name] for name in dict.fromkeys(workers)]
    n, n_workers = logs.size, len(groups)
    if n_workers < 2 or n <= n_workers:
        raise ValueError("two workers at least, and two times of one of them, are needed to tell how far they differ")
    within = sum(float(((group - group.mean()) ** 2).sum()) for group in groups) / (n - n_workers)
    among = sum(group.size * float((group.mean() - logs.mean()) ** 2) for group in groups) / (n_workers - 1)
    n0 = (n - sum(group.size**2 for group in groups) / n) / (n_workers - 1)
    between = max(0.0, (among - within) / n0)
    return between / (between + within) if between + within > 0 else 0.0
