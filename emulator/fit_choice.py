"""``scheme="auto"``: which of the emulator's densities foretells held-out repetitions and held-out people best."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from emulator.choice import Choice, chosen, dealt_folds, energy_scores, people_folds
from emulator.fit_settings import FitSettings, Progress
from emulator.judge.distance import distances
from emulator.model import SCHEMES, MotionEmulator
from emulator.registered import Registered

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
    unit = _Unit.of(made)
    overs = dict.fromkeys(over for over, _ in folds)
    scores = {name: {over: np.full(len(index), np.nan) for over in overs} for name in SCHEMES}
    steps = [(name, over, mask) for name in SCHEMES for over, mask in folds]
    for done, (name, over, held) in enumerate(steps):
        if progress is not None:
            progress(done, len(steps), "scheme")
        model = build(subset(made, ~held), replace(settings, scheme=name))
        scores[name][over][held] = unit.foretold(model, held, over, settings.seed)
    return chosen(scores, index)


def subset(made: Registered, mask: np.ndarray) -> Registered:
    """The registered repetitions of a mask (N,)."""
    at = np.flatnonzero(mask)
    holds = tuple(made.holds[i] for i in at)
    return Registered(made.whole.subset(at), made.moving.subset(at), holds, made.warps[at], made.directions[at])


@dataclass(frozen=True, eq=False)
class _Unit:
    """Distances of posture and of log duration, each over its mean among the recordings, added up.

    directions : (N, T, B, 3); log_s : (N,); names : (N,) whose; posture, time : the mean distances
    """

    directions: np.ndarray
    log_s: np.ndarray
    names: np.ndarray
    posture: float
    time: float

    @classmethod
    def of(cls, made: Registered) -> _Unit:
        log_s = np.log(made.whole.duration_s)
        names = np.array([motion.worker for motion in made.whole.motions])
        pairs = max(len(log_s) * (len(log_s) - 1), 1)
        posture, time = distances(made.directions).sum() / pairs, np.abs(log_s[:, None] - log_s).sum() / pairs
        return cls(made.directions, log_s, names, posture or 1.0, time or 1.0)

    def foretold(self, model: MotionEmulator, held: np.ndarray, over: str, seed: int) -> np.ndarray:
        """Energy score of each held-out repetition: by draws of its own person if known, else of new people."""
        at = np.flatnonzero(held)
        found = np.empty(len(at))
        for name in [None] if over == "workers" else np.unique(self.names[at]).tolist():
            of = np.full(len(at), True) if name is None else self.names[at] == name
            drawn = model.sample(N_DRAWN, np.random.default_rng([seed, int(at[of][0])]), worker=name)
            found[of] = self._scores(model.aligned_directions(drawn.scores), np.log(drawn.duration_s), at[of])
        return found

    def _scores(self, directions: np.ndarray, log_s: np.ndarray, at: np.ndarray) -> np.ndarray:
        posture = energy_scores(distances(directions, self.directions[at]), distances(directions))
        time = energy_scores(np.abs(log_s[:, None] - self.log_s[at]), np.abs(log_s[:, None] - log_s))
        return posture / self.posture + time / self.time
