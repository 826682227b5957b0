"""How a CovariateModel is fitted: partial least squares, then the category, then what is left for a new person."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.covariates.distribution import f_test, left_out_effects, level_effects
from emulator.covariates.model import CovariateModel
from emulator.covariates.regression import kept, noise_p, pls1
from emulator.covariates.table import Ready, mistakes_of, of_people

PEOPLE_A_COMPONENT, MOST_COMPONENTS = 4, 5
"""One component for every four people: with more, six people foretold new ones worse than their mean did."""
HARDLY_MORE = 0.02
"""A gain of leave-one-out R^2 for which no further component is taken."""


def fit(
    means: np.ndarray,
    numeric: np.ndarray,
    names: Sequence[str],
    category: Sequence[str | None] | None,
    category_name: str,
    groups: np.ndarray | None,
    families: np.ndarray | None,
    level: float,
    keep: str,
) -> CovariateModel:
    """See ``CovariateModel.fit``."""
    means, numeric = np.asarray(means, float), np.asarray(numeric, float)
    wrong = mistakes_of(means, numeric, names, category, groups, families, level, keep)
    if wrong:
        raise ValueError("\n".join(wrong))
    groups = np.arange(len(means)) if groups is None else np.asarray(groups)
    known = Ready.of(numeric, names, category, groups)
    numbers = _numbers(known, means, level, keep, families)
    return _model(known, category_name, numbers, _sexes(known, means, numbers, level, keep, families), means)


def _model(known: Ready, category: str, numbers: _Numbers, sexes: _Sexes, means: np.ndarray) -> CovariateModel:
    """What both steps found, and how well it foretells."""
    return CovariateModel(
        names=known.names,
        low=known.low,
        high=known.high,
        left_out=known.left_out,
        centre=known.x.mean(axis=0),
        slope=numbers.slope,
        category=category,
        levels=known.levels,
        level_effect=sexes.effect,
        gaussian=known.gaussian,
        n_people=known.folds.n_people,
        n_components=numbers.n_components,
        noise_p=numbers.p,
        category_p=sexes.p,
        **_accuracy(sexes, of_people(means, known.folds.groups)),
    )


def _accuracy(sexes: _Sexes, people: np.ndarray) -> dict[str, np.ndarray]:
    """r2 and error_spread, each (K,), of the whole model; people (G, K) are their mean scores."""
    total = np.sum((people - people.mean(axis=0)) ** 2, axis=0)
    ratio = _ratio(np.sum(sexes.errors**2, axis=0), np.sum(sexes.plain**2, axis=0))
    return {"r2": 1.0 - ratio, "error_spread": np.sqrt(total / max(len(people) - 1, 1) * ratio)}


@dataclass(frozen=True, eq=False)
class _Numbers:
    """The step by partial least squares: slope (P, K), and how it was decided."""

    n_components: np.ndarray
    p: np.ndarray
    slope: np.ndarray


def _numbers(known: Ready, means: np.ndarray, level: float, keep: str, families: np.ndarray | None) -> _Numbers:
    n_scores, folds = means.shape[1], known.folds
    most = min(folds.n_people // PEOPLE_A_COMPONENT, len(known.names), MOST_COMPONENTS)
    if most == 0:
        none = np.zeros(n_scores, int)
        return _Numbers(none, np.full(n_scores, np.nan), np.zeros((len(known.names), n_scores)))
    r2 = folds.r2(means, most)
    best = r2[1:].max(axis=0)
    p = noise_p(folds, means, best, most)
    fewest = np.argmax(r2 >= best - HARDLY_MORE, axis=0)
    count = np.where(kept(p, level, keep, families) & (best > 0), fewest, 0)
    slopes = pls1(known.x, means, most)[1]
    return _Numbers(count, p, np.take_along_axis(slopes, count[None, None], axis=0)[0])


@dataclass(frozen=True, eq=False)
class _Sexes:
    """The step by category: effect (C, K), p (K,); and of each person what the whole model leaves, (G, K).

    residual : of the fit; errors : with the person left out; plain : the same with the others' mean as forecast
    """

    effect: np.ndarray
    p: np.ndarray
    residual: np.ndarray
    errors: np.ndarray
    plain: np.ndarray


def _sexes(
    known: Ready, means: np.ndarray, numbers: _Numbers, level: float, keep: str, families: np.ndarray | None
) -> _Sexes:
    folds = known.folds
    y, x = of_people(means, folds.groups), of_people(known.x, folds.groups)
    residual = y - means.mean(axis=0) - (x - known.x.mean(axis=0)) @ numbers.slope
    mean, slopes = folds.slopes(means, int(numbers.n_components.max(initial=0)))
    slope = np.take_along_axis(slopes, numbers.n_components[None, None, None], axis=0)[0]
    centred = x - (known.x - folds.x)[0]
    errors = y - mean - np.einsum("gp,gpk->gk", centred - folds.mean, slope)
    plain = y - mean
    if not known.levels:
        return _Sexes(np.zeros((0, y.shape[1])), np.full(y.shape[1], np.nan), residual, errors, plain)
    p = f_test(residual, known.member)
    passed = kept(p, level, keep, families)
    effect = level_effects(residual, known.member) * passed
    at = np.flatnonzero(passed)
    away = centred[None] - folds.mean[:, None]
    without = y[None, :, at] - mean[:, None, at] - np.einsum("ghp,gpk->ghk", away, slope[:, :, at])
    errors[:, at] -= left_out_effects(without, known.member)
    return _Sexes(effect, p, residual - known.member @ effect, errors, plain)


def _ratio(above: np.ndarray, below: np.ndarray) -> np.ndarray:
    return np.where(below > 0, above / np.where(below > 0, below, 1.0), 1.0)
