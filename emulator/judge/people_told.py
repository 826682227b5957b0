"""What the covariates that recordings bring along (``cov_*``) tell of how their people differ: a description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from emulator.anova import anova
from emulator.covariates.category import left_out_effects, levels_of, members
from emulator.covariates.left_out import Folds
from emulator.covariates.model import CovariateModel, logged
from emulator.covariates.table import PREFIX, CovariateTable, table_of
from emulator.fit_people import FEWEST_PEOPLE
from emulator.motion import MotionSet

OF_PEOPLE = 0.9
"""Share of its variance that lies between people, from which a covariate is theirs. Head heights have 0.99 or more,
top speeds, which are the movement's own, 0.9 or less."""


@dataclass(frozen=True)
class Told:
    """What one covariate tells of one quantity.

    r2   : leave-one-person-out R^2; below 0 where it foretells people worse than the others' mean does
    p    : how often noise reaches it, of a category by its F test (NaN where it could not be tested)
    kept : whether that is not noise, at 95 % with a covariate's quantities corrected for one another
    """

    covariate: str
    quantity: str
    r2: float
    p: float
    kept: bool


@dataclass(frozen=True)
class ByCovariates:
    """told : a row for each covariate and quantity; notes : which covariates tell nothing, and why, in words."""

    told: tuple[Told, ...]
    notes: tuple[str, ...]


def by_covariates(motions: MotionSet, quantities: Mapping[str, np.ndarray]) -> ByCovariates:
    """Ask each covariate alone of the people's means of quantities (N,), one value a repetition of ``motions``."""
    names, notes = _of_people(motions)
    index = motions.worker_index
    means = np.stack([[x[index == w].mean() for x in quantities.values()] for w in range(len(motions.workers))])
    rows: list[Told] = []
    for name in names:
        category = _is_word(_values(motions, name))
        table = table_of(motions, *([[], name] if category else [[name]])).of_people()
        known = np.array([word is not None for word in table.category]) if category else ~np.isnan(table.numeric[:, 0])
        if category and not levels_of(table.category):
            notes.append(f"{name}: found no two levels of two people each")
        elif known.sum() < FEWEST_PEOPLE:
            notes.append(f"{name}: known of {known.sum()} people, expected {FEWEST_PEOPLE}: a line fits fewer by luck")
        else:
            rows += _told(name, table, known, means, list(quantities))
    return ByCovariates(tuple(rows), tuple(notes))


def _told(
    name: str, table: CovariateTable, known: np.ndarray, means: np.ndarray, quantities: Sequence[str]
) -> list[Told]:
    at, of_words = np.flatnonzero(known), not table.names
    words = [table.category[i] for i in at]
    category = words if of_words else None
    model = CovariateModel.fit(means[at], table.numeric[at], table.names, category, category_name=name)
    r2 = _r2_of_words(words, means[at]) if of_words else _r2(logged(table.names, table.numeric[at]), means[at])
    p = model.category_p if of_words else model.noise_p
    return [Told(name, *row) for row in zip(quantities, r2.tolist(), p.tolist(), model.explained.tolist())]


def _r2(x: np.ndarray, means: np.ndarray) -> np.ndarray:
    """(K,) of a line through one covariate x (G, 1)."""
    return Folds.of(x, np.arange(len(x))).r2(means, 1)[1]


def _r2_of_words(words: Sequence[str | None], means: np.ndarray) -> np.ndarray:
    """(K,) of the mean of the others with the same word."""
    n = len(means)
    others = (means.sum(axis=0) - means) / (n - 1)
    plain = means - others
    errors = plain - left_out_effects(means[None] - others[:, None], members(words, levels_of(words)))
    squares = np.sum(plain**2, axis=0)
    return 1.0 - np.sum(errors**2, axis=0) / np.where(squares > 0, squares, 1.0)


def _of_people(motions: MotionSet) -> tuple[list[str], list[str]]:
    """Covariates that say who somebody is, and notes on the others (none on one that never varies)."""
    names, notes = [], []
    for name in dict.fromkeys(key for motion in motions.motions for key in motion.covariates):
        plain, values = name.removeprefix(PREFIX), _values(motions, name)
        if len({value for value in values if not _unknown(value)}) < 2:
            continue
        why = _changes(values, motions.worker_index)
        if why:
            notes.append(f"{plain}: {why}")
        else:
            names.append(plain)
    if names and len(motions.workers) < FEWEST_PEOPLE:
        found = f"found {len(motions.workers)} people, expected {FEWEST_PEOPLE} or more"
        return [], [*notes, f"{', '.join(names)}: {found}: a line fits fewer by luck"]
    return names, notes


def _changes(values: Sequence[Any], index: np.ndarray) -> str:
    """Why a covariate (N values) is not the person's but the repetition's; empty if it is the person's."""
    if _is_word(values):
        own = {(w, value) for w, value in zip(index.tolist(), values) if not _unknown(value)}
        return "" if len(own) <= len({w for w, _ in own}) else "a word that changes within people"
    there = np.array([not _unknown(value) for value in values])
    numbers = np.array([float(value) for value, known in zip(values, there) if known])
    parts = anova(numbers[:, None], index[there])
    between, within = float(parts.between[0]), float(parts.within_square[0])
    if between >= OF_PEOPLE * (between + within):
        return ""
    share = f"{100 * between / (between + within):.0f} %"
    return f"{share} of its variance lies between people, expected {100 * OF_PEOPLE:.0f} % of what is a person's own"


def _values(motions: MotionSet, name: str) -> list[Any]:
    keys = (name, f"{PREFIX}{name}")
    return [next((m.covariates[key] for key in keys if key in m.covariates), None) for m in motions.motions]


def _is_word(values: Sequence[Any]) -> bool:
    return any(isinstance(value, str) and value for value in values)


def _unknown(value: Any) -> bool:
    return value is None or value == "" or value != value
