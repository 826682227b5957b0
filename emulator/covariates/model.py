"""What the covariates say, in words: of a fit, and of a body that was asked for.

CovariateModel: the mean joint coordinates of people explained by their bodies, and foretold for a new body.

Two steps (Baydal-Bertomeu et al., section 5 of the procedure, eq. 3-6): numeric covariates (height, mass, age, pace)
by partial least squares, each score with the number of components that leave-one-person-out R^2 asks for; then a
category (sex) by a linear model on what is left, kept where its F test passes. Beyond the paper: a forecast must beat
noise (see ``noise``), the scores are corrected for one another, a person counts once however often recorded, and gaps
in what is known of a person are filled by the conditional mean.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from emulator.covariates.body import Body, BodyError
from emulator.covariates.distribution import CovariateGaussian

OUTSIDE = ("clamp", "refuse")
NOT_THERE = "not in the recordings"


@dataclass(frozen=True)
class CovariateUse:
    """What became of one covariate of a body: asked and used (None: unknown, not used), the training range, how.

    how : "as asked", "clamped", "expected" (unknown: the conditional mean given the known) or "not in the recordings"
    """

    name: str
    asked: float | str | None
    low: float | None
    high: float | None
    used: float | str | None
    how: str

    def __str__(self) -> str:
        asked = "unknown" if self.asked is None else f"asked {_word(self.asked)}"
        if self.how == NOT_THERE:
            return f"{self.name}: {asked}, {NOT_THERE}: it changes nothing here"
        known = f"recorded {self.low:.4g} to {self.high:.4g}" if self.low is not None else "recorded"
        return f"{self.name}: {asked}, {known}, used {_word(self.used)} ({self.how})"


@dataclass(frozen=True, eq=False)
class Prediction:
    """mean (K,): the shift of the mean coordinates; uses: what became of each covariate."""

    mean: np.ndarray
    uses: tuple[CovariateUse, ...]

    @property
    def clamped(self) -> tuple[str, ...]:
        """Names of the covariates that lay outside the recordings."""
        return tuple(use.name for use in self.uses if use.how == "clamped")

    @property
    def unused(self) -> tuple[str, ...]:
        """Names of covariates that were asked for, are not in the recordings and change nothing elsewhere either."""
        return tuple(use.name for use in self.uses if use.how == NOT_THERE)

    @property
    def lines(self) -> list[str]:
        return [str(use) for use in self.uses]


def explain(model: CovariateModel, body: Body, outside: str, elsewhere: Collection[str] = ()) -> Prediction:
    """See ``CovariateModel.explain``. Raises BodyError for a body outside the range where that is refused."""
    pass

    if outside not in OUTSIDE:
        raise ValueError(f"outside: no {outside!r}; known: {', '.join(OUTSIDE)}")
    known = body.known
    asked = np.array([known.get(name, np.nan) for name in model.names])
    wrong = _outside(model, asked, body) if outside == "refuse" else []
    if wrong:
        raise BodyError(wrong)
    clamped = np.clip(asked, model.low, model.high)
    sex = body.sex if body.sex in model.levels else None
    values = np.concatenate([logged(model.names, clamped[None]), level_shares([sex], model.levels)], axis=1)
    filled = model.gaussian.filled(values)
    uses = _numbers(model, asked, clamped, filled[0]) + _sex(model, body, filled[0])
    uses += [CovariateUse(n, v, None, None, None, NOT_THERE) for n, v in known.items() if n not in model.names]
    told = tuple(use for use in uses if use.how != NOT_THERE or use.name not in elsewhere)
    return Prediction(model.of_values(filled)[0], told)


def _outside(model: CovariateModel, asked: np.ndarray, body: Body) -> list[str]:
    wrong = [
        f"body: {name}: found {value:.6g}, recorded {low:.4g} to {high:.4g}"
        for name, value, low, high in zip(model.names, asked, model.low, model.high)
        if value < low or value > high
    ]
    if body.sex is not None and model.levels and body.sex not in model.levels:
        wrong.append(f"body: {model.category}: found {body.sex!r}, recorded {', '.join(model.levels)}")
    return wrong


def _numbers(model: CovariateModel, asked: np.ndarray, clamped: np.ndarray, filled: np.ndarray) -> list[CovariateUse]:
    pass

    uses = []
    for i, name in enumerate(model.names):
        unknown = bool(np.isnan(asked[i]))
        expected = float(np.exp(filled[i]) if name in LOGGED else filled[i])
        how = "expected" if unknown else "as asked" if asked[i] == clamped[i] else "clamped"
        used = expected if unknown else float(clamped[i])
        given = None if unknown else float(asked[i])
        uses.append(CovariateUse(name, given, float(model.low[i]), float(model.high[i]), used, how))
    return uses


def _sex(model: CovariateModel, body: Body, filled: np.ndarray) -> list[CovariateUse]:
    if not model.levels:
        return [] if body.sex is None else [CovariateUse("sex", body.sex, None, None, None, NOT_THERE)]
    if body.sex in model.levels:
        return [CovariateUse(model.category, body.sex, None, None, body.sex, "as asked")]
    later = np.clip(filled[len(model.names) :], 0.0, 1.0)
    later = later / max(later.sum(), 1.0)
    mix = ", ".join(f"{s:.0%} {level}" for level, s in zip(model.levels, [1.0 - later.sum(), *later]))
    return [CovariateUse(model.category, body.sex, None, None, mix, "expected")]


def fit_lines(model: CovariateModel) -> list[str]:
    """What the fit found: how many scores are explained, by how much, what was left out and why."""
    by_numbers = int(np.sum(model.n_components > 0))
    by_sex = int(np.sum(np.any(model.level_effect != 0, axis=0)))
    k, told = model.slope.shape[1], model.explained
    lines = [
        f"{', '.join(model.names) or 'no numeric covariate'} of {model.n_people} people: {by_numbers} of {k} scores "
        f"explained by partial least squares, {by_sex} by {model.category}"
        + (f" ({', '.join(model.levels)})" if model.levels else " (not two levels of two people each)")
    ]
    if np.any(told):
        best = model.r2[told]
        lines.append(
            f"leave-one-person-out R^2 of the {int(told.sum())} explained: {best.min():.2f} to {best.max():.2f}"
        )
    return lines + [f"{name} left out: {why}" for name, why in model.left_out]


def _word(value: float | str | None) -> str:
    return value if isinstance(value, str) else "nothing" if value is None else f"{value:.4g}"


LOGGED = ("pace",)
"""Ratios enter as logarithms: twice as fast and half as fast are equally far from the usual."""


@dataclass(frozen=True, eq=False)
class CovariateModel:
    """P numeric covariates and C levels of a category -> shifts of K mean coordinates.

    names (P,), low and high (P,): the covariates used and their range in training; left_out : (name, why) of others
    centre (P,), slope (P, K) : on the covariates, those of ``LOGGED`` as logarithms; 0 where they say nothing
    category : what the category is called; levels (C,), level_effect (C, K) : 0 where the F test does not pass
    gaussian : of the covariates and of the levels but the first
    n_components (K,), noise_p (K,), category_p (K,) : how each score was decided (NaN where it could not be tested)
    r2 (K,) : of the whole model with the person left out; 0 where nothing is kept
    error_spread (K,) : standard deviation of a new person's mean about ``predict``
    """

    names: tuple[str, ...]
    low: np.ndarray
    high: np.ndarray
    left_out: tuple[tuple[str, str], ...]
    centre: np.ndarray
    slope: np.ndarray
    category: str
    levels: tuple[str, ...]
    level_effect: np.ndarray
    gaussian: CovariateGaussian
    n_people: int
    n_components: np.ndarray
    noise_p: np.ndarray
    category_p: np.ndarray
    r2: np.ndarray
    error_spread: np.ndarray

    @classmethod
    def fit(
        cls,
        means: np.ndarray,
        numeric: np.ndarray,
        names: Sequence[str],
        category: Sequence[str | None] | None = None,
        *,
        category_name: str = "sex",
        groups: np.ndarray | None = None,
        families: np.ndarray | None = None,
        level: float = 0.95,
        keep: str = "fdr",
    ) -> CovariateModel:
        """From means (R, K) of people (or of people at several paces), their covariates and a category each.

        numeric  : (R, P), NaN where unknown; names : (P,)
        category : R words, None where unknown; one person has one
        groups   : (R,) which person a row is of, 0 to G - 1; None: each row is a person of its own
        families : (K,) numbers; scores of one family are corrected for one another (None: all are one family)
        keep     : "fdr" controls false discoveries over the scores at 1 - level; "each" asks ``level`` score by score
        No luck enters: the same rows give the same model. Raises ValueError for shapes that do not fit, all at once.
        """
        from emulator.covariates.fitting import fit

        return fit(means, numeric, names, category, category_name, groups, families, level, keep)

    @property
    def explained(self) -> np.ndarray:
        """(K,) whether the covariates say anything of a score."""
        return np.any(self.slope != 0, axis=0) | np.any(self.level_effect != 0, axis=0)

    @property
    def telling(self) -> tuple[str, ...]:
        """The covariates, and the category, that say something of some score; ``names`` are all that could be asked."""
        numbers = tuple(name for name, slope in zip(self.names, self.slope) if np.any(slope != 0))
        return numbers + ((self.category,) if np.any(self.level_effect != 0) else ())

    def predict(self, body: Any, outside: str = "clamp") -> np.ndarray:
        """(K,) how this body's mean coordinates are expected to differ from the mean of the training people.

        body    : a Body, a mapping or an object with such attributes
        outside : "clamp" takes the nearest recorded value of a covariate out of range, "refuse" raises BodyError
        """
        return self.explain(body, outside).mean

    def explain(self, body: Any, outside: str = "clamp", *, elsewhere: Collection[str] = ()) -> Prediction:
        """The same with what became of each covariate: asked, range, used.

        elsewhere : covariates that do something outside this model; where it has them not, nothing is said of them
        """
        return explain(self, Body.of(body, self.names), outside, elsewhere)

    def shifts(self, numeric: np.ndarray, category: Sequence[str | None] | None = None) -> np.ndarray:
        """(R, K) the shifts of rows of covariates (R, P) in the order of ``names``; NaN and None are filled."""
        filled = self.gaussian.filled(np.concatenate([logged(self.names, numeric), self._levels(category, numeric)], 1))
        return self.of_values(filled)

    def of_values(self, values: np.ndarray) -> np.ndarray:
        """(R, K) shifts of values (R, P + C - 1): covariates as the model takes them, shares of later levels."""
        shift = (values[:, : len(self.names)] - self.centre) @ self.slope
        if not self.levels:
            return np.asarray(shift)
        later = np.clip(values[:, len(self.names) :], 0.0, 1.0)
        later = later / np.maximum(later.sum(axis=1, keepdims=True), 1.0)
        return np.asarray(shift + np.column_stack([1.0 - later.sum(axis=1), later]) @ self.level_effect)

    def _levels(self, category: Sequence[str | None] | None, numeric: np.ndarray) -> np.ndarray:
        """(R, C - 1) shares of the later levels, NaN where unknown."""
        return level_shares(category if category is not None else [None] * len(numeric), self.levels)

    @property
    def lines(self) -> list[str]:
        """What was found, in words for a report."""
        return fit_lines(self)


def logged(names: Sequence[str], numeric: np.ndarray) -> np.ndarray:
    """Covariates (R, P) as the model takes them."""
    numeric = np.array(numeric, float)
    at = [i for i, name in enumerate(names) if name in LOGGED]
    numeric[:, at] = np.log(numeric[:, at])
    return numeric


def level_shares(category: Sequence[str | None], levels: tuple[str, ...]) -> np.ndarray:
    """(R, C - 1) 1 where a row is of a level but the first, NaN where its level is none of them."""
    rows = [[float(one == level) if one in levels else np.nan for level in levels[1:]] for one in category]
    return np.array(rows, float).reshape(len(category), max(len(levels) - 1, 0))
