"""What the covariates say, in words: of a fit, and of a body that was asked for."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from emulator.covariates.body import Body, BodyError

if TYPE_CHECKING:
    from emulator.covariates.model import CovariateModel

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
    from emulator.covariates.model import level_shares, logged

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
    from emulator.covariates.model import LOGGED

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
