"""What is found of the people of one task: how far they differ, and how well each is foretold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.judge.people_told import ByCovariates


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
