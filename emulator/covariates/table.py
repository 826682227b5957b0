"""The covariates of the people in recordings, as the table that a CovariateModel takes.

What keeps rows from being explained: every mistake with what was found and expected.

Covariates made ready for a fit: which can say something, their gaps filled, people and levels numbered.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

import numpy as np

from emulator.covariates.body import ALIASES, RANGES, number_mistake, sex_word
from emulator.covariates.distribution import CovariateGaussian, levels_of, members, words_of_people
from emulator.covariates.model import level_shares, logged
from emulator.covariates.regression import Folds, summed
from emulator.motion import Motion, MotionSet

PREFIX = "cov_"


@dataclass(frozen=True, eq=False)
class CovariateTable:
    """workers (G,); names (P,), numeric (R, P) with NaN where unknown; category (R,) words, None where unknown.

    groups (R,) : the number of each row's worker
    """

    workers: tuple[str, ...]
    names: tuple[str, ...]
    numeric: np.ndarray
    category: tuple[str | None, ...]
    groups: np.ndarray

    def without(self, worker: int) -> CovariateTable:
        """The rows of the others, their workers numbered anew."""
        others = self.groups != worker
        rows = np.flatnonzero(others)
        return CovariateTable(
            tuple(name for g, name in enumerate(self.workers) if g != worker),
            self.names,
            self.numeric[rows],
            tuple(self.category[i] for i in rows),
            self.groups[rows] - (self.groups[rows] > worker),
        )

    def of_people(self) -> CovariateTable:
        """One row a worker: means of the numbers that are known, the first word that is."""
        own = [self.numeric[self.groups == g] for g in range(len(self.workers))]
        return CovariateTable(
            self.workers,
            self.names,
            np.array([_known_mean(rows) for rows in own]).reshape(len(own), len(self.names)),
            tuple(words_of_people(self.category, self.groups)),
            np.arange(len(self.workers)),
        )

    def body(self, worker: int) -> dict[str, Any]:
        """What is known of a worker, as ``Body.of`` reads it: mean numbers and the category under "sex"."""
        one = self.of_people()
        known = {name: float(value) for name, value in zip(self.names, one.numeric[worker]) if not np.isnan(value)}
        return known if one.category[worker] is None else known | {"sex": one.category[worker]}


def table_of(motions: MotionSet, names: Sequence[str] | None = None, category: str = "sex") -> CovariateTable:
    """One row a repetition, in the order of the motions.

    names    : numeric covariates to take, with or without "cov_"; None: those of a Body that any repetition has
    category : the covariate that is a word
    Raises ValueError that names task, repetition and covariate, for every number that cannot be, a name that no
    repetition has (with the nearest), and a worker of two categories; one who is of none in some repetitions is not.
    """
    rows = [_named(motion) for motion in motions.motions]
    there = set().union(*rows)
    wanted = [_plain(name) for name in names] if names is not None else [name for name in RANGES if name in there]
    wrong = [_unknown(motions.task, name, there) for name in wanted if name not in there]
    wrong += [
        w
        for motion, row in zip(motions.motions, rows)
        for w in _mistakes(f"{motions.task}: {motion.name}", row, wanted)
    ]
    words = tuple(_word(row.get(_plain(category))) for row in rows)
    groups = motions.worker_index
    wrong += [
        f"{motions.task}: worker {name!r}: {category}: found {' and '.join(sorted(own))}, expected one"
        for g, name in enumerate(motions.workers)
        if len(own := {word for word, of in zip(words, groups) if of == g and word is not None}) > 1
    ]
    if wrong:
        raise ValueError("\n".join(wrong))
    numeric = [[np.nan if row.get(name) is None else float(row[name]) for name in wanted] for row in rows]
    return CovariateTable(motions.workers, tuple(wanted), np.array(numeric).reshape(len(rows), -1), words, groups)


def asked_table(motions: MotionSet, asked: Sequence[str] = ()) -> CovariateTable:
    """``table_of`` with the numbers of a body that the recordings have, and the columns that were asked for by name.

    Raises ValueError as ``table_of``, and for a column asked for that can tell nothing, by name and all at once.
    """
    there = _columns(motions)
    names = [_plain(name) for name in asked]
    wrong = [_unknown(motions.task, name, there) for name in dict.fromkeys(names) if name not in there]
    wrong += [w for name in dict.fromkeys(names) if name in there for w in _useless(motions, name)]
    if wrong:
        raise ValueError("\n".join(wrong))
    return table_of(motions, list(dict.fromkeys([*(name for name in RANGES if name in there), *names])))


def unused_columns(motions: MotionSet, asked: Sequence[str] = ()) -> list[str]:
    """Names of columns that no fit reads: neither of a body, nor asked for, nor what repetitions were chosen by."""
    read = {*RANGES, "sex", *(_plain(name) for name in asked), *map(_plain, re.findall(r"\w+", motions.selection))}
    return sorted(_columns(motions) - read)


def _columns(motions: MotionSet) -> set[str]:
    return set().union(*(_named(motion) for motion in motions.motions))


def _useless(motions: MotionSet, name: str) -> list[str]:
    """Why a column cannot explain how people differ; nothing where it can."""
    place, values = f"{motions.task}: covariate {name!r}", [_named(motion).get(name) for motion in motions.motions]
    words = [value for value in values if value is not None and not isinstance(value, (int, float, np.number))]
    if words:
        return [f"{place}: found {words[0]!r}, expected numbers"]
    column = np.array([np.nan if value is None else float(value) for value in values])[:, None]
    n_people = len(motions.workers)
    if n_people < FEWEST_PEOPLE:
        return [f"{place}: found recordings of {n_people} people, expected {FEWEST_PEOPLE} or more"]
    left_out = _usable(column, [name], motions.worker_index)[1]
    return [f"{place}: found it {why}, expected a number that tells people apart" for _, why in left_out]


def _named(motion: Motion) -> dict[str, Any]:
    return {_plain(key): None if _missing(value) else value for key, value in motion.covariates.items()}


def _plain(name: str) -> str:
    bare = name.removeprefix(PREFIX)
    return ALIASES.get(bare, bare)


def _missing(value: Any) -> bool:
    """NaN and the empty word are how a file says that it does not know."""
    return value is None or value == "" or (isinstance(value, float) and np.isnan(value))


def _mistakes(place: str, row: dict[str, Any], wanted: Sequence[str]) -> list[str]:
    found = (number_mistake(f"{place}: {PREFIX}{name}", name, row.get(name)) for name in wanted)
    return [wrong for wrong in found if wrong is not None]


def _word(value: Any) -> str | None:
    return None if value is None else sex_word(str(value))


def _unknown(task: str, name: str, there: set[str]) -> str:
    near = get_close_matches(name, sorted(there), n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(sorted(there)) or 'none'}"
    return f"{task}: no covariate {name!r}; {hint}"


def _known_mean(rows: np.ndarray) -> list[float]:
    return [
        float(np.mean(column[~np.isnan(column)])) if np.any(~np.isnan(column)) else float("nan") for column in rows.T
    ]


KEEPS = ("fdr", "each")


def mistakes_of(
    means: np.ndarray,
    numeric: np.ndarray,
    names: Sequence[str],
    category: Sequence[str | None] | None,
    groups: np.ndarray | None,
    families: np.ndarray | None,
    level: float,
    keep: str,
) -> list[str]:
    """Lines, empty if all is well."""
    if means.ndim != 2 or numeric.ndim != 2 or len(means) == 0:
        return [
            f"covariates: found means {means.shape} and numeric {numeric.shape}, expected (rows, scores), (rows, P)"
        ]
    wrong = []
    if len(numeric) != len(means) or numeric.shape[1] != len(names):
        wrong.append(f"covariates: numeric: found {numeric.shape}, expected ({len(means)}, {len(names)})")
    if not np.all(np.isfinite(means)):
        wrong.append(f"covariates: means: found {int(np.sum(~np.isfinite(means)))} numbers that are not finite")
    if np.any(np.isinf(numeric)):
        wrong.append(f"covariates: numeric: found {int(np.sum(np.isinf(numeric)))} infinite numbers")
    wrong += [f"covariates: {name!r} is named twice" for name in dict.fromkeys(names) if list(names).count(name) > 1]
    if "pace" in names and numeric.shape[1] == len(names) and np.any(numeric[:, list(names).index("pace")] <= 0):
        wrong.append("covariates: pace: found 0 or less, expected ratios above 0")
    wrong += _of_settings(means.shape[1], families, level, keep)
    return wrong + _of_people(len(means), category, groups)


def _of_settings(n_scores: int, families: np.ndarray | None, level: float, keep: str) -> list[str]:
    wrong = []
    if not 0.5 <= level < 1:
        wrong.append(f"covariates: level: found {level}, expected a share from 0.5 to below 1")
    if keep not in KEEPS:
        near = get_close_matches(str(keep), KEEPS, n=1)
        wrong.append(
            f"covariates: keep: no {keep!r}; " + (f"did you mean {near[0]!r}?" if near else "known: fdr, each")
        )
    if families is not None and np.shape(families) != (n_scores,):
        wrong.append(f"covariates: families: found {np.shape(families)}, expected ({n_scores},)")
    return wrong


def _of_people(n_rows: int, category: Sequence[str | None] | None, groups: np.ndarray | None) -> list[str]:
    wrong = []
    if category is not None and len(category) != n_rows:
        wrong.append(f"covariates: category: found {len(category)}, expected {n_rows}")
    if groups is None:
        return wrong
    groups = np.asarray(groups)
    if groups.shape != (n_rows,) or groups.dtype.kind not in "iu":
        return [*wrong, f"covariates: groups: found {groups.shape} {groups.dtype}, expected ({n_rows},) whole numbers"]
    if groups.min() < 0 or len(np.unique(groups)) != groups.max() + 1:
        return [*wrong, "covariates: groups: expected each number from 0 to the largest"]
    if category is not None and len(category) == n_rows:
        for g in range(int(groups.max()) + 1):
            own = sorted({str(word) for word, of in zip(category, groups) if of == g and word is not None})
            if len(own) > 1:
                wrong.append(f"covariates: person {g} is of {len(own)} categories: {', '.join(own)}")
    return wrong


FEWEST_PEOPLE = 4
"""With fewer, one left out leaves two: any line goes through them."""
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
