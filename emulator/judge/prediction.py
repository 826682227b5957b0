"""Choosing among schemes by cross-validation: held-out repetitions of known people, and people held out whole.

The judge is the energy score, E|X - y| - E|X - X'| / 2 of draws X and what then happened, y: a strictly proper score,
so that neither a copier nor a scheme that draws too widely gains by it (Gneiting & Raftery 2007, sec. 4.3).

How well draws foretell recordings that had no part in the fit: the energy score of posture and of log duration.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from emulator.fitting.registration import Registered
from emulator.judge.sequence_distances import distances
from emulator.model.performances import MotionPerformances

N_FOLDS = 5
MOST_PEOPLE_FOLDS = 10
OVER = {"repetitions": "repetitions held out", "workers": "people held out"}


@dataclass(frozen=True)
class Choice:
    """scheme : the chosen one; scores : scheme -> mean energy score over each of ``OVER``; why : in a sentence."""

    scheme: str
    scores: dict[str, dict[str, float]]
    why: str


def energy_scores(across: np.ndarray, among: np.ndarray) -> np.ndarray:
    """Energy score (m,) of m happenings from distances (n, m) of n >= 2 draws to them and (n, n) among the draws."""
    n = len(among)
    return np.asarray(across.mean(axis=0) - 0.5 * among.sum() / (n * (n - 1)))


def dealt_folds(worker_index: np.ndarray, rng: np.random.Generator, n_folds: int = N_FOLDS) -> list[np.ndarray]:
    """Masks (N,) of held-out repetitions: each worker's dealt at random over the folds; one of a kind is never out."""
    fold = np.full(len(worker_index), -1)
    for worker in np.unique(worker_index):
        own = np.flatnonzero(worker_index == worker)
        if len(own) > 1:
            fold[rng.permutation(own)] = (np.arange(len(own)) + worker) % min(n_folds, len(own))
    return [fold == k for k in range(n_folds) if np.any(fold == k)]


def people_folds(worker_index: np.ndarray, most: int = MOST_PEOPLE_FOLDS) -> list[np.ndarray]:
    """Masks (N,) of people held out, one in each fold, or several where there are more than ``most``; none of one."""
    people = np.unique(worker_index)
    if len(people) < 2:
        return []
    return [np.isin(worker_index, people[k::most]) for k in range(min(most, len(people)))]


def chosen(scores: Mapping[str, Mapping[str, np.ndarray]], worker_index: np.ndarray) -> Choice:
    """The scheme whose energy scores, each over the best there, have the smallest mean.

    scores : scheme -> one of ``OVER`` -> (N,) score of each repetition, NaN where it was never held out; at least one
             is finite. The first of equals wins.
    """
    mean = {
        name: {over: _of_people(values, worker_index).mean() for over, values in of.items()}
        for name, of in scores.items()
    }
    best = {over: min(of[over] for of in mean.values()) for over in next(iter(mean.values()))}
    relative = {name: float(np.mean([of[over] / best[over] for over in of])) for name, of in mean.items()}
    first, *others = sorted(relative, key=lambda name: relative[name])
    plain = {name: {over: float(value) for over, value in of.items()} for name, of in mean.items()}
    return Choice(first, plain, _why(first, others, scores, plain, worker_index))


def _of_people(values: np.ndarray, worker_index: np.ndarray) -> np.ndarray:
    """Mean score of each person who was ever held out."""
    known = np.isfinite(values)
    return np.array([values[known & (worker_index == w)].mean() for w in np.unique(worker_index[known])])


def _why(
    first: str,
    others: list[str],
    scores: Mapping[str, Mapping[str, np.ndarray]],
    mean: Mapping[str, Mapping[str, float]],
    worker_index: np.ndarray,
) -> str:
    if not others:
        return f"{first}: the only one asked about"
    second = others[0]
    parts = []
    for over in mean[first]:
        ahead = _of_people(scores[second][over], worker_index) - _of_people(scores[first][over], worker_index)
        error = ahead.std(ddof=1) / np.sqrt(len(ahead)) if len(ahead) > 1 else 0.0
        doubt = "" if abs(ahead.mean()) > error else ", less apart than the standard error over people"
        won = f"better for {int(np.sum(ahead > 0))} of {len(ahead)} people"
        parts.append(f"{OVER[over]} {mean[first][over]:.3f} against {mean[second][over]:.3f} ({won}{doubt})")
    among = f" (best of {len(others) + 1}, next {second})" if len(others) > 1 else f" rather than {second}"
    return f"{first}{among}: energy score of {'; '.join(parts)}"


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

        Each over its mean distance among the recordings, so that their sum judges both; see ``energy_scores``.
        """
        directions, log_s = drawn.aligned_directions(), np.log(drawn.duration_s)
        posture = energy_scores(distances(directions, self.directions[at]), distances(directions))
        time = energy_scores(np.abs(log_s[:, None] - self.log_s[at]), np.abs(log_s[:, None] - log_s))
        return np.stack([posture / self.posture_rad, time / self.log_time], axis=1)
