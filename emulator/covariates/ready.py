"""Covariates made ready for a fit: which can say something, their gaps filled, people and levels numbered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.covariates.category import levels_of, members, words_of_people
from emulator.covariates.gaussian import CovariateGaussian
from emulator.covariates.left_out import Folds, summed
from emulator.covariates.model import level_shares, logged

FEWEST_KNOWN = 3
"""People of whom a covariate must be known."""


@dataclass(frozen=True, eq=False)
class Ready:
    """Covariates made ready: x (R, P) without gaps; member (G, C); range of what was recorded."""

    names: tuple[str, ...]
    low: np.ndarray
    high: np.ndarray
    left_out: tuple[tuple[str, str], ...]
    x: np.ndarray
    folds: Folds
    levels: tuple[str, ...]
    member: np.ndarray
    gaussian: CovariateGaussian

    @classmethod
    def of(
        cls, numeric: np.ndarray, names: Sequence[str], category: Sequence[str | None] | None, groups: np.ndarray
    ) -> Ready:
        use, left_out = _usable(numeric, names, groups)
        chosen = tuple(names[i] for i in use)
        raw, x = numeric[:, use], logged(chosen, numeric[:, use])
        n_people = int(groups.max()) + 1
        people = words_of_people(category, groups) if category is not None else [None] * n_people
        levels = levels_of(people)
        shares = level_shares(people, levels)
        gaussian = CovariateGaussian.fit(np.concatenate([x, shares[groups]], axis=1), n_people)
        x = gaussian.filled(np.concatenate([x, shares[groups]], axis=1))[:, : len(use)]
        member = members(people, levels) if levels else np.zeros((n_people, 0))
        low, high = np.nanmin(raw, axis=0, initial=np.inf), np.nanmax(raw, axis=0, initial=-np.inf)
        return cls(chosen, low, high, left_out, x, Folds.of(x, groups), levels, member, gaussian)


def _usable(numeric: np.ndarray, names: Sequence[str], groups: np.ndarray) -> tuple[list[int], tuple]:
    """Numbers of the covariates that can say something, and (name, why) of the others."""
    use, left_out = [], []
    for i, name in enumerate(names):
        column = numeric[:, i]
        count = int(np.sum(~np.isnan(of_people(column[:, None], groups))))
        if count < FEWEST_KNOWN:
            left_out.append((name, f"known of {count} people, {FEWEST_KNOWN} are needed"))
        elif np.nanmax(column) - np.nanmin(column) <= 1e-9 * np.nanmax(np.abs(column)):
            left_out.append((name, "the same for everybody"))
        else:
            use.append(i)
    return use, tuple(left_out)


def of_people(values: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """(G, ...) means over each person's rows (R, ...), of what is known; NaN where nothing is."""
    there = ~np.isnan(values)
    count = summed(there.astype(float), groups)
    return np.where(count > 0, summed(np.where(there, values, 0.0), groups) / np.maximum(count, 1.0), np.nan)
