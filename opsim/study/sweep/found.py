"""What a sweep found of one figure: means at the points, what each factor does, a fitted response, the best point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from opsim.results import Key
from opsim.scenario.schema.studies.sweep import SENSITIVITY
from opsim.study.interval import Interval, t_interval
from opsim.study.sweep.best import Best, best_of
from opsim.study.sweep.by_fit import effects_by_fit
from opsim.study.sweep.designs import MORRIS_STEP
from opsim.study.sweep.effects import Swing, main_effects, tornado
from opsim.study.sweep.factors import AS_IT_IS, UNCHANGED, Factor
from opsim.study.sweep.fit_errors import block_error
from opsim.study.sweep.points import Points
from opsim.study.sweep.response import Response, fit_response
from opsim.study.sweep.sensitivity import Sensitivity, morris_effects, sobol_indices

AGAINST_BASE, OVER_OTHERS, BY_FIT = "base", "mean", "fit"


@dataclass(frozen=True)
class Found:
    """One figure. means : a point each; how : what the changes of ``swings`` are against; noise_share : of the variance
    of the points' means, how much is luck (nan where it is not known)
    """

    key: Key
    means: tuple[Interval, ...]
    how: str = ""
    swings: tuple[Swing, ...] = ()
    response: Response | None = None
    no_response: str = ""
    sensitivity: tuple[Sensitivity, ...] = ()
    best: Best | None = None
    noise_share: float = float("nan")
    replications: int = 1
    factors: tuple[Factor, ...] = field(default=(), repr=False)


def found_of(key: Key, better: str, points: Points, values: np.ndarray, seed: int) -> Found:
    """values : (P, n) of the figure, replications with common random numbers; seed : of the bootstrap's intervals."""
    means = tuple(t_interval(row) for row in values)
    known = [one for one in means if one.n]
    best = best_of(values, means, better) if better and len(known) > 1 else None
    found = Found(key, means, best=best, replications=values.shape[1], factors=points.factors)
    if points.design in SENSITIVITY:
        return replace(found, sensitivity=_sensitivity(points, means, seed), noise_share=_noise_share(values))
    if points.design == "one_at_a_time":
        return replace(found, how=AGAINST_BASE, swings=tuple(_against_base(points, values)))
    response, why = _response(points, values)
    complete = values[:, ~np.isnan(values).any(axis=0)]
    if points.design == "grid" and complete.size:
        how, swings = OVER_OTHERS, main_effects(points.array, complete, *_names(points.factors))
    else:
        how, swings = BY_FIT, [] if response is None else effects_by_fit(points.factors, response)
    return replace(found, how=how, swings=tuple(swings), response=response, no_response=why)


def _against_base(points: Points, values: np.ndarray) -> list[Swing]:
    ends = {}
    for column, factor in enumerate(points.factors):
        rows = [row for row in range(1, len(values)) if points.values[row][column] is not UNCHANGED]
        ends[factor.path] = {factor.words(points.values[row][column]): values[row] for row in rows}
    bases = {path: _base_name(points.bases.get(path), of) for path, of in ends.items()}
    return tornado(values[0], ends, bases)


def _base_name(said: str | None, ends: Mapping[str, object]) -> str:
    """What the scenario has, in words: an end where it is one of them."""
    if said is None or said in ends:
        return AS_IT_IS if said is None else said
    return f"{said} ({AS_IT_IS})"


def _names(factors: Sequence[Factor]) -> tuple[list[str], list[list[str]]]:
    return [f.path for f in factors], [[f.words(value) for value in f.grid_values()] for f in factors]


def _response(points: Points, values: np.ndarray) -> tuple[Response | None, str]:
    """The fit, or why there is none."""
    spans = [factor.span if not factor.categories else (0.0, 1.0) for factor in points.factors]
    low, high = zip(*spans)
    categories = [factor.categories for factor in points.factors]
    try:
        return fit_response(points.numbers(), values, low=low, high=high, categories=categories), ""
    except ValueError as error:
        return None, str(error)


def _sensitivity(points: Points, means: Sequence[Interval], seed: int) -> tuple[Sensitivity, ...]:
    """Nothing where a point has no value: the designs need all of theirs."""
    y = np.array([one.mean for one in means])
    if np.isnan(y).any():
        return ()
    n = len(points.factors)
    if points.design == "morris":
        return tuple(morris_effects(points.array, y, n, seed, [_moved(factor) for factor in points.factors]))
    return tuple(sobol_indices(y, n, seed))


def _moved(factor: Factor) -> float:
    """By which share of its range a factor moves at a step of Morris' paths; values without order change as a whole."""
    if factor.categories > 1:
        return 1.0
    return round(MORRIS_STEP * factor.steps) / factor.steps if factor.steps else MORRIS_STEP


def _noise_share(values: np.ndarray) -> float:
    known = values[~np.isnan(values).any(axis=1)]
    if len(known) < 2 or known.shape[1] < 2 or np.ptp(known.mean(axis=1)) == 0:
        return float("nan")
    return min(1.0, block_error(known) / known.shape[1] / float(known.mean(axis=1).var(ddof=1)))
