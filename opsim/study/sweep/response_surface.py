"""By how much a fit misses: points left out (PRESS), lack of fit, pure error, misfit.

Source: Montgomery, Design and Analysis of Experiments, 8th ed., sections 10.7 and 10.8.

The terms of a response: what a factor, its square, and two factors together add to a figure.

A fitted response: a second-order polynomial of the factors, with its error and a word on whether to trust it.

Why not weighted by the scatter of each point: variances of a few replications are too rough to be weights, and common
random numbers make the points' errors go together. Least squares of each replication by itself is right in both cases:
n fits, as alike as the replications are, and Student's interval of their mean.
Source: Kleijnen, Design and Analysis of Simulation Experiments, 2nd ed. 2015, sections 3.4 and 3.5 (common random
numbers); Montgomery, Design and Analysis of Experiments, 8th ed., sections 10.7 (PRESS) and 10.8 (lack of fit).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from opsim.study.intervals import CONFIDENCE


def leaves_one_out(design: np.ndarray) -> bool:
    """Whether the fit exists, and still does without any one of its points."""
    points, terms = design.shape
    return points > terms and np.linalg.matrix_rank(design) == terms and bool((_leverage(design) < 1 - 1e-9).all())


def _leverage(design: np.ndarray) -> np.ndarray:
    """(P,) how much a point pulls the fit to itself: the diagonal of the hat matrix."""
    q, _ = np.linalg.qr(design)
    return np.asarray((q**2).sum(axis=1))


def press_of(design: np.ndarray, means: np.ndarray) -> float:
    """Sum of squares by which points are missed by the fit without them; no fit is done again (Montgomery, 10.7)."""
    left_out = residuals(design, means) / (1 - _leverage(design))
    return float(left_out @ left_out)


def residuals(design: np.ndarray, means: np.ndarray) -> np.ndarray:
    """(P,) by how much the least-squares fit misses the points that it was fitted to."""
    return np.asarray(means - design @ np.linalg.lstsq(design, means, rcond=None)[0])


def lack_of_fit(design: np.ndarray, y: np.ndarray) -> float:
    """p of the F test that luck alone explains by how much the points are missed; nan where n is 1 or no point spare.

    design : (P, C); y : (P, n) of replications with common random numbers. Source: ``pure_error``.
    """
    from scipy.special import fdtrc

    n, spare = y.shape[1], design.shape[0] - design.shape[1]
    if n < 2 or spare < 1:
        return float("nan")
    pure, lack = pure_error(design, y), n * _mean_square(design, y)
    tiny = (1e-9 * np.abs(y).max(initial=0)) ** 2
    if pure <= tiny:
        return 1.0 if lack <= tiny else 0.0
    return float(fdtrc(spare, (n - 1) * spare, lack / pure))


def pure_error(design: np.ndarray, y: np.ndarray) -> float:
    """Variance of one replication at one point around that replication's own fit; nan where n is 1.

    Each replication has a fit of its own, so luck that is common to all points, or that tilts or bends them as the fit
    can, is no pure error: with common random numbers it is most of the luck, and would hide what the fit misses.
    Source: Kleijnen 2015, section 3.4 (replications fitted one by one); the F test is that of Montgomery, 10.8.
    """
    (points, terms), n = design.shape, y.shape[1]
    if n < 2 or points <= terms:
        return float("nan")
    misses = _each_residual(design, y)
    return float(((misses - misses.mean(axis=1, keepdims=True)) ** 2).sum()) / ((n - 1) * (points - terms))


def misfit(design: np.ndarray, y: np.ndarray) -> float:
    """Variance by which the truth at a point lies beside the best fit: what the misses have beyond luck, at least 0.

    Of one replication luck cannot be told, so all of the misses counts.
    """
    luck = pure_error(design, y) / y.shape[1] if y.shape[1] > 1 else 0.0
    return max(0.0, _mean_square(design, y) - luck)


def block_error(y: np.ndarray) -> float:
    """Variance of one replication at one point, apart from what is common to a point or a replication; y : (P, n).

    Source: Montgomery, 8th ed., section 4.1 (randomised blocks).
    """
    points, n = y.shape
    if n < 2 or points < 2:
        return float("nan")
    left = y - y.mean(axis=1, keepdims=True) - y.mean(axis=0, keepdims=True) + y.mean()
    return float((left**2).sum()) / ((points - 1) * (n - 1))


def _mean_square(design: np.ndarray, y: np.ndarray) -> float:
    """Of the misses of the means."""
    misses = residuals(design, y.mean(axis=1))
    return float(misses @ misses) / (design.shape[0] - design.shape[1])


def _each_residual(design: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(P, n) by how much each replication's own fit misses it."""
    return np.asarray(y - design @ np.linalg.lstsq(design, y, rcond=None)[0])


def t_of(degrees: int) -> float:
    """Student's quantile of a two-sided interval."""
    from scipy.special import stdtrit

    return float(stdtrit(max(1, degrees), (1 + CONFIDENCE) / 2))


Part = tuple[int, int]
"""(factor, what of it): 1 and 2 are its first and second power; -k is its k-th category against the mean of all."""


@dataclass(frozen=True, slots=True)
class Room:
    """What the points are spread over.

    low, high  : (F,) ends of each factor; they are -1 and 1 for the fit
    categories : (F,) number of categories of a factor whose values are 0, 1, 2, ... without order; 0 for numbers
    """

    low: np.ndarray
    high: np.ndarray
    categories: tuple[int, ...]

    @property
    def centre(self) -> np.ndarray:
        """(F,) the middle of each factor."""
        return (self.low + self.high) / 2

    @property
    def half(self) -> np.ndarray:
        """(F,) half the range of each factor; 1 where it has none."""
        return np.where(self.high > self.low, (self.high - self.low) / 2, 1.0)

    def scaled(self, points: np.ndarray) -> np.ndarray:
        """(P, F) numbers from -1 to 1; categories stay as they are."""
        plain = np.array(self.categories) > 0
        return np.where(plain, points, (points - self.centre) / self.half)


def first_parts(room: Room, points: np.ndarray) -> list[list[Part]]:
    """For each factor the parts of a response that is linear in it; none where it has one value only."""
    found = []
    for factor, n in enumerate(room.categories):
        seen = np.unique(points[:, factor]).size
        found.append([] if seen < 2 else [(factor, -k) for k in range(1, n)] if n else [(factor, 1)])
    return found


def offers(room: Room, points: np.ndarray) -> list[tuple[str, list[tuple[Part, ...]]]]:
    """Responses that may be fitted, by name, from the least: linear, with squares, with interactions, with both."""
    first = first_parts(room, points)
    linear: list[tuple[Part, ...]] = [(), *((part,) for parts in first for part in parts)]
    numbers = [f for f, n in enumerate(room.categories) if not n and np.unique(points[:, f]).size > 2]
    squares: list[tuple[Part, ...]] = [((factor, 2),) for factor in numbers]
    pairs: list[tuple[Part, ...]] = [(a, b) for one, other in combinations(first, 2) for a in one for b in other]
    found = [("linear", linear)]
    if squares:
        found.append(("linear with squares", linear + squares))
    if pairs:
        found.append(("linear with interactions", linear + pairs))
    if squares and pairs:
        found.append(("quadratic", linear + squares + pairs))
    return found


def columns(terms: Sequence[tuple[Part, ...]], scaled: np.ndarray, room: Room) -> np.ndarray:
    """(P, C) what each term multiplies. scaled : (P, F) as ``Room.scaled`` gives them"""
    found = np.ones((len(scaled), len(terms)))
    for place, term in enumerate(terms):
        for factor, what in term:
            x = scaled[:, factor]
            found[:, place] *= x**what if what > 0 else (x == -what) * 1.0 - (x == 0)
    return found


TRUSTED_R2, SHARP = 0.8, 2.0
"""Of prediction: below, a fit says too little. A misfit is one where points are missed by so many times their noise."""


@dataclass(frozen=True, slots=True)
class Prediction:
    """Of a figure at a point: ``low`` and ``high`` hold the true mean, as far as the fit is as good between the points
    as at those that were left out."""

    mean: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Response:
    """A fitted response of one figure, on factors scaled to -1 ... 1.

    kind, terms     : linear, ... and what it consists of; the first term is the constant
    coefficients    : (C,); per_replication (C, n), empty where there is one replication only
    half_widths     : (C,) of their 95 % intervals
    loo_rmse        : root mean square by which a point is missed by the fit without it (leave one out)
    noise           : standard error of a point's mean by luck that no fit of a replication takes up (nan where n is 1)
    r2, r2_predicted: share of the points' variation that the fit explains; the same for points left out
    lack_of_fit_p   : of the F test against pure error: below 0.05, noise alone does not explain the misses
    misfit          : variance by which the truth at a point lies beside the best fit of this kind
    inverse         : (C, C) inverse of the normal matrix X'X
    """

    room: Room
    kind: str
    terms: tuple[tuple[Part, ...], ...]
    coefficients: np.ndarray
    per_replication: np.ndarray
    half_widths: np.ndarray
    n_points: int
    loo_rmse: float
    noise: float
    r2: float
    r2_predicted: float
    lack_of_fit_p: float
    misfit: float
    inverse: np.ndarray

    @property
    def spare(self) -> int:
        """Points beyond those that the terms use up."""
        return self.n_points - len(self.terms)

    @property
    def trusted(self) -> bool:
        """Whether it may be read between the points."""
        return self.r2_predicted >= TRUSTED_R2 and not (self.bent and self.r2_predicted < 0.95)

    @property
    def bent(self) -> bool:
        """Whether it misses the points clearly by more than their noise."""
        return bool(self.lack_of_fit_p < 1 - CONFIDENCE and self.loo_rmse > SHARP * self.noise)

    def means(self, points: np.ndarray | Sequence[Sequence[float]]) -> np.ndarray:
        """(P,) of points (P, F) in the factors' own units."""
        return columns(self.terms, self.room.scaled(self._inside(points)), self.room) @ self.coefficients

    def at(self, point: Sequence[float]) -> Prediction:
        """At one point, in the factors' own units. Raises ValueError outside the room that was looked at."""
        row = columns(self.terms, self.room.scaled(self._inside([point])), self.room)[0]
        half = np.hypot(self.half_of(row), t_of(self.spare) * self.loo_rmse)
        mean = float(row @ self.coefficients)
        return Prediction(mean, mean - float(half), mean + float(half))

    def half_of(self, row: np.ndarray) -> float:
        """Half-width of the 95 % interval of a sum of coefficients, as far as replications differ."""
        if self.per_replication.size == 0:
            return 0.0
        n = self.per_replication.shape[1]
        return float(t_of(n - 1) * (row @ self.per_replication).std(ddof=1) / np.sqrt(n))

    def misfit_of(self, row: np.ndarray, points: int) -> float:
        """Standard error that the misfit gives a sum of coefficients which stands for so many points of the truth: by
        the coefficients, and by the points' own distance from the best fit."""
        return float(np.sqrt(self.misfit * (row @ self.inverse @ row + points)))

    def _inside(self, points: np.ndarray | Sequence[Sequence[float]]) -> np.ndarray:
        found = np.asarray(points, dtype=float)
        slack = 1e-9 * self.room.half
        outside = (found < self.room.low - slack) | (found > self.room.high + slack)
        if outside.any():
            row, factor = np.argwhere(outside)[0]
            raise ValueError(
                f"factor {factor} at {found[row, factor]:g} lies outside of what was looked at, "
                f"{self.room.low[factor]:g} to {self.room.high[factor]:g}"
            )
        return found


def fit_response(
    points: np.ndarray | Sequence[Sequence[float]],
    values: np.ndarray | Sequence[float],
    *,
    low: Sequence[float] | None = None,
    high: Sequence[float] | None = None,
    categories: Sequence[int] | None = None,
    kind: str | None = None,
) -> Response:
    """The response that misses points left out by least: linear, with squares, with interactions, or quadratic (both).

    points     : (P, F) in the factors' own units; a row may be there more than once
    values     : (P, n) of n replications with common random numbers, or (P,)
    low, high  : (F,) ends of each factor; by default those of the points
    categories : (F,) for a factor whose values 0, 1, 2, ... have no order, how many there are; 0 for numbers
    kind       : "linear", "linear with squares", "linear with interactions" or "quadratic", instead of the best one
    Points and replications without a value (nan) are left out.
    Raises ValueError where there are too few points for a line.
    """
    x = np.asarray(points, dtype=float)
    y = np.asarray(values, dtype=float).reshape(len(x), -1)
    x, y = _known(x, y)
    room = Room(
        np.asarray(x.min(axis=0, initial=np.inf) if low is None else low, dtype=float),
        np.asarray(x.max(axis=0, initial=-np.inf) if high is None else high, dtype=float),
        tuple(categories or [0] * x.shape[1]),
    )
    scaled = room.scaled(x)
    found = [(kind, terms, columns(terms, scaled, room)) for kind, terms in offers(room, x)]
    possible = [one for one in found if kind in (None, one[0]) and leaves_one_out(one[2])]
    if not possible:
        raise ValueError(
            f"{len(np.unique(x, axis=0))} points are too few to fit a {kind or 'response'} of {x.shape[1]} factors"
        )
    best = min(possible, key=lambda one: (round(press_of(one[2], y.mean(axis=1)), 12), len(one[1])))
    return _fitted(room, *best, y)


def _known(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    rows = ~np.isnan(y).all(axis=1)
    y = y[rows]
    y = y[:, ~np.isnan(y).any(axis=0)]
    if y.size == 0:
        raise ValueError("there is no replication with a value at every point, so no response is fitted")
    return x[rows], y


def _fitted(room: Room, kind: str, terms: list[tuple[Part, ...]], design: np.ndarray, y: np.ndarray) -> Response:
    means, n = y.mean(axis=1), y.shape[1]
    each = np.linalg.lstsq(design, y, rcond=None)[0]
    misses, around = residuals(design, means), means - means.mean()
    total, press = float(around @ around), press_of(design, means)
    spare, inverse = len(means) - len(terms), np.linalg.inv(design.T @ design)
    if n > 1:
        halves = t_of(n - 1) * each.std(axis=1, ddof=1) / np.sqrt(n)
    else:
        spread = np.diag(inverse) * float(misses @ misses) / spare
        halves = t_of(spare) * np.sqrt(spread)
    flat = total <= (1e-12 * np.abs(means).max(initial=0)) ** 2 * len(means)
    return Response(
        room=room,
        kind=kind,
        terms=tuple(terms),
        coefficients=each.mean(axis=1),
        per_replication=each if n > 1 else np.empty((len(terms), 0)),
        half_widths=halves,
        n_points=len(means),
        loo_rmse=float(np.sqrt(press / len(means))),
        noise=float(np.sqrt(pure_error(design, y) / n)),
        r2=1.0 if flat else 1 - float(misses @ misses) / total,
        r2_predicted=1.0 if flat else 1 - press / total,
        lack_of_fit_p=lack_of_fit(design, y),
        misfit=misfit(design, y),
        inverse=inverse,
    )
