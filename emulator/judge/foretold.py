"""How well draws foretell recordings that had no part in the fit: the energy score of posture and of log duration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.choice import energy_scores
from emulator.judge.distance import distances
from emulator.performances import MotionPerformances
from emulator.registered import Registered


@dataclass(frozen=True, eq=False)
class Unseen:
    """Registered recordings, and the mean distances among them, which make scores of posture and time alike.

    directions : (N, T, B, 3); log_s : (N,) log of the whole duration; names : (N,) whose they are
    posture_rad, log_time : mean distance of two of them (1 where they are all the same)
    """

    directions: np.ndarray
    log_s: np.ndarray
    names: np.ndarray
    posture_rad: float
    log_time: float

    @classmethod
    def of(cls, made: Registered) -> Unseen:
        log_s = np.log(made.whole.duration_s)
        names = np.array([motion.worker for motion in made.whole.motions])
        pairs = max(len(log_s) * (len(log_s) - 1), 1)
        posture, time = distances(made.directions).sum() / pairs, np.abs(log_s[:, None] - log_s).sum() / pairs
        return cls(made.directions, log_s, names, posture or 1.0, time or 1.0)

    def scores(self, drawn: MotionPerformances, at: np.ndarray) -> np.ndarray:
        """(A, 2) energy scores of posture and of log duration of the recordings ``at`` (A,): small is good.

        Each over its mean distance among the recordings, so that their sum judges both; see ``emulator.choice``.
        """
        directions, log_s = drawn.model.aligned_directions(drawn.scores), np.log(drawn.duration_s)
        posture = energy_scores(distances(directions, self.directions[at]), distances(directions))
        time = energy_scores(np.abs(log_s[:, None] - self.log_s[at]), np.abs(log_s[:, None] - log_s))
        return np.stack([posture / self.posture_rad, time / self.log_time], axis=1)
