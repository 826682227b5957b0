"""How people of one task differ, and what it is worth to know who works: repetitions and people left out one by one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.anova import intraclass_correlation
from emulator.choice import people_folds
from emulator.fit_parts import parts_of
from emulator.fit_settings import FitSettings, Progress
from emulator.fitting import model_of
from emulator.judge.foretold import Unseen
from emulator.model import MotionEmulator
from emulator.motion import MotionSet
from emulator.performances import MotionPerformances
from emulator.registered import Registered, registered

N_DRAWN, N_SCORES, FEWEST = 200, 3, 3


@dataclass(frozen=True)
class Icc:
    """Intraclass correlation ICC(1,1) of a quantity with its 95 % interval (NaN where it cannot be estimated)."""

    quantity: str
    icc: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class People:
    """What was found of one task with N repetitions; scores are energy scores of posture and log duration, (N, 2).

    known  : by draws of the repetition's own worker, that repetition left out of the fit
    pooled : by draws of that same fit which ask for nobody
    new    : by draws of new people, the repetition's worker left out whole
    NaN where leaving out left fewer than three repetitions, or none of that worker. names : (N,) whose they are
    """

    task: str
    names: np.ndarray
    iccs: tuple[Icc, ...]
    known: np.ndarray
    pooled: np.ndarray
    new: np.ndarray

    def closer(self) -> dict[str, bool]:
        """worker -> whether his own draws foretell his unseen repetitions better than pooled draws do, all in all."""
        gain = (self.pooled - self.known).sum(axis=1)
        own = {name: gain[(self.names == name) & np.isfinite(gain)] for name in sorted(set(self.names.tolist()))}
        return {name: bool(some.mean() > 0) for name, some in own.items() if len(some)}


def people_of(motions: MotionSet, settings: FitSettings, progress: Progress = None) -> People:
    """Fit without each repetition, and without each worker, and judge what is foretold.

    Registered once, with all: the clock has seen what is left out. Raises ValueError for fewer than two workers.
    """
    if len(motions.workers) < 2:
        raise ValueError(f"{motions.task}: found the recordings of one worker, expected two or more to tell apart")
    made = registered(motions.in_order(), settings, None)
    unseen, n = Unseen.of(made), len(made.whole)
    index = made.moving.worker_index
    one_by_one, folds = np.eye(n, dtype=bool), people_folds(index)
    found = {name: np.full((n, 2), np.nan) for name in ("known", "pooled", "new")}
    for done, held in enumerate([*one_by_one, *folds]):
        if progress is not None:
            progress(done, n + len(folds), "left out")
        if np.sum(~held) < FEWEST:
            continue
        model = model_of(made.subset(~held), settings)
        at, of_people = np.flatnonzero(held), done >= n
        found["new" if of_people else "pooled"][at] = unseen.scores(_drawn(model, settings.seed, None), at)
        if not of_people and unseen.names[at[0]] in model.workers:
            found["known"][at] = unseen.scores(_drawn(model, settings.seed, unseen.names[at[0]]), at)
    return People(motions.task, unseen.names, iccs(made, settings), **found)


def iccs(made: Registered, settings: FitSettings) -> tuple[Icc, ...]:
    """Of log duration and of the first posture and pace scores."""
    parts, index = parts_of(made, settings), made.moving.worker_index
    rows = [Icc("log duration", *intraclass_correlation(np.log(made.whole.duration_s), index))]
    for block in ("posture", "pace"):
        scores = parts.z[:, parts.scale.block(block)][:, :N_SCORES]
        rows += [Icc(f"{block} score {k + 1}", *intraclass_correlation(s, index)) for k, s in enumerate(scores.T)]
    return tuple(rows)


def _drawn(model: MotionEmulator, seed: int, worker: str | None) -> MotionPerformances:
    return model.sample(N_DRAWN, np.random.default_rng([seed, 6]), worker=worker)
