"""The covariates of the people in recordings, as the table that a CovariateModel takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

import numpy as np

from emulator.covariates.body import ALIASES, RANGES, number_mistake, sex_word
from emulator.covariates.category import words_of_people
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
