"""Two stages: the spread of each system from the first, and as many replications as it needs in the second."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from opsim.kpi.catalogue import MORE
from opsim.study.select.constants import dudewicz_dalal_h, rinott_h
from opsim.study.select.selection import (
    CHOSEN,
    RAN_OUT,
    Answered,
    Asked,
    Observe,
    Selection,
    Stage,
    plain_means,
    sign_of,
)

ASSUMES = (
    "means of replications are normally distributed (nearly so where many jobs pass)",
    "replications are independent, and so are variants: each has random numbers of its own",
)


def rinott(
    observe: Observe,
    systems: Sequence[str],
    *,
    indifference: float,
    confidence: float = 0.95,
    better: str = MORE,
    first_stage: int = 20,
    most: int = 10_000,
) -> Selection:
    """The system with the best mean of both stages. Raises ValueError as ``Asked`` and ``Answered`` do.

    Source: Rinott 1978; that what is chosen is within the indifference of the best, whatever the means, with the same
    chance: Nelson & Matejcik 1995, Management Science 41:1935-1945.
    """
    asked = Asked(tuple(systems), indifference, confidence, better, first_stage, most)
    answered, sd = _first_stage(observe, asked)
    h = rinott_h(asked.k, confidence, first_stage)
    needed = np.maximum(first_stage, _whole(np.square(h * sd / indifference)))
    promise = f"what is chosen is the best, or within the indifference of it, {_chance(asked)}"
    enough = float(h * sd.max() / np.sqrt(most))
    return _second_stage(answered, asked, needed, np.full(asked.k, np.nan), "rinott", promise, enough)


def dudewicz_dalal(
    observe: Observe,
    systems: Sequence[str],
    *,
    indifference: float,
    confidence: float = 0.95,
    better: str = MORE,
    first_stage: int = 20,
    most: int = 10_000,
) -> Selection:
    """The system with the best weighted mean of both stages: fewer replications than Rinott's, and odder means.

    Source: Dudewicz & Dalal 1975; Law, Simulation Modeling and Analysis, 5th ed., section 10.2.1, eqs. 10.1-10.4.
    """
    asked = Asked(tuple(systems), indifference, confidence, better, first_stage, most)
    answered, sd = _first_stage(observe, asked)
    h = dudewicz_dalal_h(asked.k, confidence, first_stage)
    needed = np.maximum(first_stage + 1, _whole(np.square(h * sd / indifference)))
    weights = np.array([first_weight(first_stage, int(n), h * s / indifference) for n, s in zip(needed, sd)])
    best = "the best is chosen"
    promise = f"{best} {_chance(asked)} where it is at least the indifference better than every other"
    enough = float(h * sd.max() / np.sqrt(most))
    return _second_stage(answered, asked, needed, weights, "dudewicz-dalal", promise, enough)


def first_weight(first_stage: int, n: int, ratio: float) -> float:
    """Weight of the first stage's mean, such that the weighted mean has variance (indifference / h)^2 sigma^2 / S^2.

    ratio : h S / indifference; where it is 0 there is no spread, and every weight gives the same mean
    """
    if ratio == 0.0:
        return first_stage / n
    rest = 1.0 - (n - first_stage) / ratio**2
    return first_stage / n * (1.0 + float(np.sqrt(max(0.0, 1.0 - n / first_stage * rest))))


def _chance(asked: Asked) -> str:
    return f"with a chance of at least {100 * asked.confidence:.4g} %"


def _whole(needed: np.ndarray) -> np.ndarray:
    """Rounded up, but for what the last bits add."""
    return np.ceil(np.minimum(needed * (1.0 - 1e-12), 1e15)).astype(np.int64)


def _first_stage(observe: Observe, asked: Asked) -> tuple[Answered, np.ndarray]:
    answered = asked.answered(observe)
    answered.upto(dict.fromkeys(range(asked.k), asked.first_stage))
    return answered, np.array([of[:, 0].std(ddof=1) for of in answered.values])


def _second_stage(
    answered: Answered,
    asked: Asked,
    needed: np.ndarray,
    weights: np.ndarray,
    procedure: str,
    promise: str,
    affordable: float,
) -> Selection:
    """weights : (k,) of the first stage's mean; nan where all replications count alike"""
    enough = bool((needed <= asked.most).all())
    if enough:
        answered.upto({i: int(n) for i, n in enumerate(needed)})
    means, limited = plain_means(answered, answered.n)
    if enough:
        means = tuple(
            mean if np.isnan(weight) else _weighted(of[:, 0], asked.first_stage, float(weight))
            for mean, weight, of in zip(means, weights, answered.values)
        )
    order = np.argsort(-sign_of(asked.better) * np.array(means), kind="stable")
    winner = asked.systems[int(order[0])] if enough else ""
    stages = [Stage(0, asked.systems), Stage(asked.first_stage, asked.systems)]
    if enough:
        stages.append(Stage(max(answered.n), (winner,)))
    return Selection(
        procedure=procedure,
        systems=asked.systems,
        winner=winner,
        ended=CHOSEN if enough else RAN_OUT,
        stages=tuple(stages),
        out=(),
        means=means,
        limited=limited,
        n=answered.n,
        asked=answered.n,
        confidence=asked.confidence,
        indifference=asked.indifference,
        promise=promise,
        assumes=ASSUMES,
        needed=tuple(map(int, needed)),
        affordable=affordable,
        values=tuple(answered.values),
    )


def _weighted(values: np.ndarray, first_stage: int, weight: float) -> float:
    return float(weight * values[:first_stage].mean() + (1.0 - weight) * values[first_stage:].mean())
