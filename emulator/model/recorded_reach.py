"""Where a joint was at a mark in the recordings, and whether a target is within what is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.model.joint_law import JointLaw
from emulator.model.reach import MARK_M, recorded
from emulator.model.targets import AXES, HandPlaces, Target, joints_of, mark_number
from emulator.people.workers import WorkerEffect

FINE, STRETCHED, REFUSED = "fine", "stretched", "refused"
MOST_SQUARE = {FINE: 6.0, STRETCHED: 16.0}
"""Squared Mahalanobis distance for each number that a target says, up to which it is fine, or stretched."""
MOST_APART_M = {FINE: 0.15, STRETCHED: 0.45}
"""The same of the distance to the nearest recorded place, in metres."""


@dataclass(frozen=True)
class Verdict:
    """word : "fine", "stretched" or "refused"; sentence : why

    mahalanobis2 : squared Mahalanobis distance of the target from the recorded places, which is that of the most likely
                   movement there from the mean one, as far as places go with movements in straight lines
    nearest_m    : to the nearest recorded place, along the axes that the target says
    """

    word: str
    mahalanobis2: float
    nearest_m: float
    sentence: str


@dataclass(frozen=True, eq=False)
class Reach:
    """Where a joint was at a mark: ``places_m`` (N, 3) ahead, aside and height of each recording, in metres.

    In the frame of ``Target``. A library of plain Gaussians has no recordings: then of draws' typical deviations.
    """

    model: JointLaw
    joint: str
    mark: str
    places_m: np.ndarray

    @classmethod
    def of(cls, model: JointLaw, joint: str, mark: str | int) -> Reach:
        """See ``MotionEmulator.reach``."""
        joints = joints_of(model.task, model.skeleton, joint)
        number = mark_number(model.task, model.mark_names, mark)
        places = HandPlaces(model, (joints,), (number,))
        return cls(model, joint, model.mark_names[number], places(recorded(model, None))[:, 0])

    def quantiles_m(self, shares: tuple[float, ...] = (0.0, 0.25, 0.5, 0.75, 1.0)) -> dict[str, np.ndarray]:
        """By axis ("height_m", "ahead_m", "aside_m"), the places below which these shares of the recordings were."""
        return {name: np.quantile(self.places_m[:, i], shares) for i, name in enumerate(AXES)}

    @property
    def height_m(self) -> tuple[float, float]:
        """Lowest and highest."""
        return float(self.places_m[:, 2].min()), float(self.places_m[:, 2].max())

    def verdict(self, target: Target, worker: WorkerEffect | None = None) -> Verdict:
        """Whether a target of this joint and mark is within what is known; of a worker: with that worker's body.

        Raises ValueError for a target of another joint or mark.
        """
        here = mark_number(self.model.task, self.model.mark_names, target.mark)
        if target.joint != self.joint or self.model.mark_names[here] != self.mark:
            raise ValueError(f"{self.model.task}: found a {target}, expected one of {self.joint} at {self.mark}")
        axes = [i for i, value in enumerate(target.place) if value is not None]
        asked = np.array([value for value in target.place if value is not None], float)
        known = self._places(worker)[:, axes]
        apart = asked - known.mean(axis=0)
        spread = np.cov(known.T).reshape(len(axes), len(axes)) + MARK_M**2 * np.eye(len(axes))
        square = float(apart @ np.linalg.solve(spread, apart))
        nearest_m = float(np.linalg.norm(known - asked, axis=1).min())
        word = next(
            (w for w in (FINE, STRETCHED) if square <= len(axes) * MOST_SQUARE[w] and nearest_m <= MOST_APART_M[w]),
            REFUSED,
        )
        return Verdict(word, square, nearest_m, self._sentence(target, word, nearest_m))

    def _places(self, worker: WorkerEffect | None) -> np.ndarray:
        if worker is None:
            return self.places_m
        number = mark_number(self.model.task, self.model.mark_names, self.mark)
        places = HandPlaces(self.model, (joints_of(self.model.task, self.model.skeleton, self.joint),), (number,))
        return places(recorded(self.model, worker.z), worker.scale)[:, 0]

    def _sentence(self, target: Target, word: str, nearest_m: float) -> str:
        said = ", ".join(f"{name.removesuffix('_m')} {v:.2f} m" for name, v in zip(AXES, target.place) if v is not None)
        low, high = self.height_m
        how = {FINE: "is within", STRETCHED: "lies a little outside of", REFUSED: "lies far outside of"}[word]
        return (
            f"{self.model.task}: {self.joint} at {self.mark} with {said} {how} what was recorded "
            f"(heights {low:.2f} to {high:.2f} m; the nearest recording is {nearest_m:.2f} m away)"
        )
