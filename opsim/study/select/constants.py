"""How much larger than the indifference a standard error may be: the constants of two-stage procedures."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

STEPS, FINE = 600, 1e-14


@lru_cache(64)
def rinott_h(k: int, confidence: float, n0: int) -> float:
    """Rinott's h: N = ceil((h S / indifference)^2) replications of each of k independent normal systems are enough.

    n0 : replications of the first stage, from which S comes
    Source: Rinott 1978, Commun. Statist. A7:799-811; E[(E[Phi(h / sqrt((n0 - 1)(1 / X + 1 / Y))) | Y])^(k - 1)] =
    confidence, X and Y independent chi-squared with n0 - 1 degrees of freedom.
    """
    _check(k, confidence, n0)
    from scipy.special import gammaln, ndtr

    freedom = n0 - 1
    # chi-squared on a scale of logarithms: the trapezoidal rule then gains digits with every point
    ends = _chi_squared_ends(freedom)
    logs = np.linspace(np.log(ends[0]), np.log(ends[1]), STEPS)
    x = np.exp(logs)
    weights = np.exp(0.5 * freedom * logs - 0.5 * x - 0.5 * freedom * np.log(2.0) - gammaln(0.5 * freedom))
    weights *= logs[1] - logs[0]
    spread = np.sqrt(freedom * (1.0 / x[:, None] + 1.0 / x[None]))

    def chance(h: float) -> float:
        return float(weights @ (ndtr(h / spread) @ weights) ** (k - 1))

    return _root(chance, confidence)


@lru_cache(64)
def dudewicz_dalal_h(k: int, confidence: float, n0: int) -> float:
    """Dudewicz and Dalal's h1, as ``rinott_h`` for weighted means: E[F(T + h1)^(k - 1)] = confidence.

    T and F are of Student's t with n0 - 1 degrees of freedom.
    Source: Dudewicz & Dalal 1975, Sankhya B37:28-78; Law, Simulation Modeling and Analysis, 5th ed., section 10.2.
    """
    _check(k, confidence, n0)
    from scipy.special import gammaln, stdtr, stdtrit

    freedom = n0 - 1
    # t = sinh(s): heavy tails of few degrees of freedom fall off as an exponential
    end = float(np.arcsinh(-stdtrit(freedom, FINE)))
    s = np.linspace(-end, end, STEPS)
    t = np.sinh(s)
    logs = gammaln(0.5 * (freedom + 1)) - gammaln(0.5 * freedom) - 0.5 * np.log(freedom * np.pi)
    weights = np.exp(logs - 0.5 * (freedom + 1) * np.log1p(t * t / freedom)) * np.cosh(s) * (s[1] - s[0])

    def chance(h: float) -> float:
        return float(weights @ stdtr(freedom, t + h) ** (k - 1))

    return _root(chance, confidence)


def kn_eta(freedom: int, error: float) -> float:
    """eta of fully sequential procedures with c = 1: (1 + 2 eta)^(-freedom / 2) / 2 = error.

    error : the chance at most that one pair (or one check of a limit) is decided the wrong way
    Source: Kim & Nelson 2001, ACM TOMACS 11:251-273, eq. 3.
    """
    if not 0 < error < 0.5:
        raise ValueError(f"a decision that is wrong with a chance of {error:.3g} needs no replications")
    return 0.5 * ((2.0 * error) ** (-2.0 / freedom) - 1.0)


def check_confidence(confidence: float, k: int) -> None:
    """Raises ValueError: a guess is right once in k times, so that less is no promise."""
    if not 1 / k < confidence < 1:
        least = f"{100 / k:.3g} %, which a guess among {k} has"
        raise ValueError(f"confidence: expected a number between {1 / k:.3g} ({least}) and 1, found {confidence:g}")


def _check(k: int, confidence: float, n0: int) -> None:
    if k < 2 or n0 < 2:
        raise ValueError(f"expected two systems or more and two replications or more, found {k} and {n0}")
    check_confidence(confidence, k)


def _chi_squared_ends(freedom: int) -> tuple[float, float]:
    from scipy.special import chdtri, gammaincinv

    return max(2.0 * float(gammaincinv(0.5 * freedom, FINE)), 1e-290), float(chdtri(freedom, FINE))


def _root(chance: Callable[[float], float], confidence: float) -> float:
    """Where an increasing function of h > 0 reaches the confidence."""
    from scipy.optimize import brentq

    high = 1.0
    while chance(high) < confidence:
        high *= 2.0
        if high > 1e9:
            raise ValueError(f"no constant for a confidence of {confidence:g} from so few replications")
    return float(brentq(lambda h: chance(h) - confidence, 0.0, high, xtol=1e-10))
