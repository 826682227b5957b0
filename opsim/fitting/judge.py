"""Which family, and does it fit? Akaike's criterion ranks; the Kolmogorov-Smirnov distance judges.

Parameters come from the same times, so the distance has no table: its p-value is found by a parametric bootstrap
(draw as many times from the fitted family, fit again, measure again), as Lilliefors (1967) did for two families.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.fitting.families import FAMILIES, Family
from opsim.streams import stream

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
