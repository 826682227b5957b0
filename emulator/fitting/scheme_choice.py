"""``scheme="auto"``: which of the emulator's densities foretells held-out repetitions and held-out people best."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from emulator.fitting.registration import Registered
from emulator.fitting.settings import FitSettings, Progress
from emulator.judge.prediction import Choice, Unseen, chosen, dealt_folds, people_folds
from emulator.model.emulator import SCHEMES, MotionEmulator

N_DRAWN, FEWEST_LEFT = 200, 3

Build = Callable[[Registered, FitSettings], MotionEmulator]


def choose(made: Registered, settings: FitSettings, build: Build, progress: Progress = None) -> Choice:
    """Every scheme fitted without each fold of ``made`` and asked to foretell it: posture and duration in one score.

    Registered once, with all: a fold's clock has seen it, the same for every scheme. A fold that leaves fewer than
    three repetitions is passed over. Raises ValueError where nothing can be held out.
    """
    index = made.moving.worker_index
    folds = [("repetitions", mask) for mask in dealt_folds(index, np.random.default_rng(settings.seed))]
    folds += [("workers", mask) for mask in people_folds(index)]
    folds = [(over, mask) for over, mask in folds if np.sum(~mask) >= FEWEST_LEFT]
    if not folds:
        raise ValueError("scheme auto: nothing can be held out of so few repetitions; name a scheme")
    unseen = Unseen.of(made)
    overs = dict.fromkeys(over for over, _ in folds)
    scores = {name: {over: np.full(len(index), np.nan) for over in overs} for name in SCHEMES}
    steps = [(name, over, mask) for name in SCHEMES for over, mask in folds]
    for done, (name, over, held) in enumerate(steps):
        if progress is not None:
            progress(done, len(steps), "scheme")
        model = build(made.subset(~held), replace(settings, scheme=name))
        scores[name][over][held] = _foretold(unseen, model, held, over, settings.seed)
    return chosen(scores, index)


def _foretold(unseen: Unseen, model: MotionEmulator, held: np.ndarray, over: str, seed: int) -> np.ndarray:
    """Energy score of each held-out repetition: by draws of its own person if known, else of new people."""
    at = np.flatnonzero(held)
    found = np.empty(len(at))
    for name in [None] if over == "workers" else np.unique(unseen.names[at]).tolist():
        of = np.full(len(at), True) if name is None else unseen.names[at] == name
        drawn = model.sample(N_DRAWN, np.random.default_rng([seed, int(at[of][0])]), worker=name)
        found[of] = unseen.scores(drawn, at[of]).sum(axis=1)
    return found
