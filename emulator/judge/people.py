"""What the covariates that recordings bring along (``cov_*``) tell of how their people differ: a description.

What is found of the people of one task: how far they differ, and how well each is foretold.

How people of one task differ, and what it is worth to know who works: repetitions and people left out one by one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from emulator.covariates.distribution import left_out_effects, levels_of, members
from emulator.covariates.model import CovariateModel, logged
from emulator.covariates.regression import Folds
from emulator.covariates.table import PREFIX, CovariateTable, table_of
from emulator.fitting.fit import model_of
from emulator.fitting.preprocessing import refuse_unsound
from emulator.fitting.registration import Registered, registered
from emulator.fitting.settings import FitSettings, Progress
from emulator.fitting.steps import FEWEST_PEOPLE, parts_of
from emulator.judge.prediction import Unseen, people_folds
from emulator.model.emulator import SCHEME, MotionEmulator
from emulator.model.performances import MotionPerformances
from emulator.motion import MotionSet
from emulator.people.variance_components import anova, intraclass_correlation

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


@dataclass(frozen=True)
class Icc:
    """Intraclass correlation ICC(1,1) of a quantity with its 95 % interval (NaN where it cannot be estimated)."""

    quantity: str
    icc: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Person:
    """Mean energy scores (2,) of posture and log duration over a worker's own repetitions; NaN where none was judged.

    known and pooled are over the same ``n_judged`` repetitions, those that could be foretold as his; new over all.
    """

    name: str
    n_repetitions: int
    n_judged: int
    known: np.ndarray
    pooled: np.ndarray
    new: np.ndarray

    @property
    def closer(self) -> bool | None:
        """Whether his own draws foretell him better than pooled draws do, all in all; None where he was not judged."""
        return bool(self.known.sum() < self.pooled.sum()) if self.n_judged else None


@dataclass(frozen=True, eq=False)
class People:
    """What was found of one task with N repetitions; scores are energy scores of posture and log duration, (N, 2).

    known  : by draws of the repetition's own worker, that repetition left out of the fit
    pooled : by draws of that same fit which ask for nobody
    new    : by draws of new people, the repetition's worker left out whole
    NaN where leaving out left fewer than three repetitions, or none of that worker.
    names, trials : (N,) whose they are, and which; told : what the people's covariates say of them
    selection, source, licence : of the recordings
    """

    task: str
    selection: str
    source: str
    licence: str
    names: np.ndarray
    trials: np.ndarray
    iccs: tuple[Icc, ...]
    known: np.ndarray
    pooled: np.ndarray
    new: np.ndarray
    told: ByCovariates

    @property
    def persons(self) -> tuple[Person, ...]:
        """One for each worker, by name."""
        return tuple(self._person(name) for name in sorted(set(self.names.tolist())))

    @property
    def over_all(self) -> Person:
        """The same means over the repetitions of everybody."""
        return self._mean("everybody", np.full(len(self.names), True))

    def _person(self, name: str) -> Person:
        return self._mean(name, self.names == name)

    def _mean(self, name: str, own: np.ndarray) -> Person:
        judged = own & np.isfinite(self.known).all(axis=1)
        means = (_mean(self.known[judged]), _mean(self.pooled[judged]), _mean(self.new[own]))
        return Person(name, int(own.sum()), int(judged.sum()), *means)


def _mean(scores: np.ndarray) -> np.ndarray:
    """(2,) mean of scores (n, 2) that are known, NaN where none is."""
    finite = scores[np.isfinite(scores).all(axis=1)]
    return finite.mean(axis=0) if len(finite) else np.full(2, np.nan)


N_DRAWN, N_SCORES = 200, 3
FEWEST_LEFT = 3
"""Repetitions that a model needs."""


def refuse(motions: MotionSet) -> None:
    """Raises ValueError with all that keeps people from being told apart: too few, or recordings with mistakes."""
    wrong = []
    if len(motions.workers) < 2:
        who = motions.workers[0]
        wrong.append(f"{motions.task}: found one worker ({who}), expected two or more to tell apart")
    if len(motions) <= FEWEST_LEFT:
        wrong.append(
            f"{motions.task}: found {len(motions)} repetitions, expected {FEWEST_LEFT + 1} or more: "
            f"one is left out, and a model needs {FEWEST_LEFT}"
        )
    for check in (refuse_unsound, table_of):
        try:
            check(motions)
        except ValueError as error:
            wrong.append(str(error))
    if wrong:
        raise ValueError("\n".join(wrong))


def usual_settings(seed: int = 0) -> FitSettings:
    """Those of ``MotionEmulator.fit``; the seed decides the draws."""
    return FitSettings(SCHEME, None, 101, 20, 0.0, seed, "")


def n_steps(motions: MotionSet) -> int:
    """Fits, registration counted as one, that ``people_of`` reports its progress by."""
    return 1 + len(motions) + len(people_folds(motions.worker_index))


def people_of(motions: MotionSet, settings: FitSettings, progress: Progress = None) -> People:
    """Fit without each repetition, and without each worker, and judge what is foretold.

    Registered once, with all: the clock has seen what is left out, for all three kinds of draws alike.
    Raises ValueError as ``refuse`` does.
    """
    refuse(motions)
    with threadpool_limits(1, user_api="blas"):  # small matrices: with two threads on two busy cores it took five times
        made = registered(motions.in_order(), settings, None)
        scores = _left_out(made, settings, progress)
        quantities = _quantities(made, settings)
    whole, index = made.whole, made.moving.worker_index
    names, trials = (np.array([getattr(m, part) for m in whole.motions]) for part in ("worker", "trial"))
    iccs = tuple(Icc(name, *intraclass_correlation(values, index)) for name, values in quantities.items())
    said = (motions.task, motions.selection, motions.source, motions.licence)
    return People(*said, names, trials, iccs, *scores, by_covariates(whole, quantities))


def _left_out(made: Registered, settings: FitSettings, progress: Progress) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Energy scores (N, 2) of each repetition: known, pooled and new."""
    unseen, n = Unseen.of(made), len(made.whole)
    known, pooled, new = (np.full((n, 2), np.nan) for _ in range(3))
    folds = [*np.eye(n, dtype=bool), *people_folds(made.moving.worker_index)]
    for step, held in enumerate(folds):
        if progress is not None:
            progress(1 + step, 1 + len(folds), "left out")
        if np.sum(~held) < FEWEST_LEFT:
            continue
        model = model_of(made.subset(~held), settings)
        at, name = np.flatnonzero(held), unseen.names[held][0]
        of_anybody = unseen.scores(_drawn(model, settings.seed, None), at)
        if step >= n:
            new[at] = of_anybody
            continue
        pooled[at] = of_anybody
        if name in model.workers:
            known[at] = unseen.scores(_drawn(model, settings.seed, name), at)
    return known, pooled, new


def _quantities(made: Registered, settings: FitSettings) -> dict[str, np.ndarray]:
    """(N,) log duration, and the first posture and pace scores."""
    parts, found = parts_of(made, settings), {"log duration": np.log(made.whole.duration_s)}
    for block in ("posture", "pace"):
        scores = parts.z[:, parts.scale.block(block)][:, :N_SCORES]
        found |= {f"{block} score {k + 1}": values for k, values in enumerate(scores.T)}
    return found


def _drawn(model: MotionEmulator, seed: int, worker: str | None) -> MotionPerformances:
    return model.sample(N_DRAWN, np.random.default_rng([seed, 6]), worker=worker)
