"""What a sweep found of one figure: means at the points, what each factor does, a fitted response, the best point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from opsim.kpi.better import LESS, MORE
from opsim.results import Key
from opsim.scenario.schema.studies.sweep import SENSITIVITY
from opsim.study.compare import holm, paired
from opsim.study.interval import CONFIDENCE, Interval, t_interval
from opsim.study.sweep.effects import Swing, main_effects, swing, tornado
from opsim.study.sweep.factors import AS_IT_IS, UNCHANGED, Factor
from opsim.study.sweep.fit_errors import pure_error
from opsim.study.sweep.points import Points
from opsim.study.sweep.response import Response, fit_response
from opsim.study.sweep.sensitivity import Sensitivity, morris_effects, sobol_indices
from opsim.study.sweep.terms import columns

AGAINST_BASE, OVER_OTHERS, BY_FIT = "base", "mean", "fit"


@dataclass(frozen=True, slots=True)
class Best:
    """The point with the best mean; ``like_it`` other points are not told from it (paired, all together, Holm)."""

    row: int
    mean: Interval
    like_it: int
    better: str


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
        how, swings = BY_FIT, [] if response is None else _by_fit(points.factors, response)
    return replace(found, how=how, swings=tuple(swings), response=response, no_response=why)


def best_of(values: np.ndarray, means: Sequence[Interval], better: str) -> Best:
    """The point with the best mean, and how many others are not told from it. values : (P, n)"""
    each = np.array([one.mean for one in means]) * {MORE: 1.0, LESS: -1.0}[better]
    row = int(np.nanargmax(each))
    others = [other for other in range(len(values)) if other != row]
    tests = [paired(values[row], values[other]) for other in others]
    same = sum(interval.n > 0 and interval.mean == 0 and interval.sd == 0 for interval, _, _ in tests)
    p = holm([np.nan if i.n > 0 and i.mean == 0 and i.sd == 0 else p for i, p, _ in tests])
    clear = int(np.count_nonzero(p <= 1 - CONFIDENCE))
    assert same + clear <= len(others)
    return Best(row, means[row], len(others) - clear, better)


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


def _by_fit(factors: Sequence[Factor], response: Response) -> list[Swing]:
    """Each factor at its ends and in its middle, the others in theirs; of categories, each against the mean of all."""
    each = response.per_replication if response.per_replication.size else response.coefficients[:, None]
    centre = columns(response.terms, _plain_centre(response), response.room)[0]
    found = []
    for column, factor in enumerate(factors):
        shares = [(value, factor.number(value), factor.words(value)) for value in factor.values]
        if not factor.categories and factor.is_range:
            middle = factor.at(0.5)
            shares.insert(1, (middle, factor.number(middle), factor.words(middle)))
        of = {words: _row(response, column, number) @ each for _, number, words in shares}
        found.append(swing(factor.path, of, centre @ each))
    return sorted(found, key=lambda one: -one.size)


def _plain_centre(response: Response) -> np.ndarray:
    """The middle of every factor; -1, which is no category, where it has no order: their mean."""
    categories = np.array(response.room.categories) > 0
    return np.where(categories, np.nan, 0.0)[None]


def _row(response: Response, column: int, number: float) -> np.ndarray:
    scaled = _plain_centre(response)
    room = response.room
    scaled[0, column] = number if room.categories[column] else (number - room.centre[column]) / room.half[column]
    return columns(response.terms, scaled, room)[0]


def _sensitivity(points: Points, means: Sequence[Interval], seed: int) -> tuple[Sensitivity, ...]:
    """Nothing where a point has no value: the designs need all of theirs."""
    y = np.array([one.mean for one in means])
    if np.isnan(y).any():
        return ()
    n = len(points.factors)
    if points.design == "morris":
        return tuple(morris_effects(points.array, y, n, seed))
    return tuple(sobol_indices(y, n, seed))


def _noise_share(values: np.ndarray) -> float:
    known = values[~np.isnan(values).any(axis=1)]
    if len(known) < 2 or known.shape[1] < 2 or np.ptp(known.mean(axis=1)) == 0:
        return float("nan")
    return min(1.0, pure_error(known) / known.shape[1] / float(known.mean(axis=1).var(ddof=1)))
