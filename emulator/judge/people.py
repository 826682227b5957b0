"""How people of one task differ, and what it is worth to know who works: repetitions and people left out one by one."""

from __future__ import annotations

import numpy as np
from threadpoolctl import threadpool_limits

from emulator.anova import intraclass_correlation
from emulator.choice import people_folds
from emulator.covariates.table import table_of
from emulator.fit_parts import parts_of
from emulator.fit_settings import FitSettings, Progress
from emulator.fitting import model_of
from emulator.judge.foretold import Unseen
from emulator.judge.people_found import Icc, People
from emulator.judge.people_told import by_covariates
from emulator.model import SCHEME, MotionEmulator
from emulator.motion import MotionSet
from emulator.performances import MotionPerformances
from emulator.registered import Registered, registered
from emulator.sound import refuse_unsound

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
