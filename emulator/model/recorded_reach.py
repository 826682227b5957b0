"""Where a joint was at a mark in the recordings, and whether a target is within what is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.model.joint_law import JointLaw
from emulator.model.reach import gaps_m, recorded
from emulator.model.targets import AXES, HANDS, HandPlaces, Target, joints_of, mark_number
from emulator.people.workers import WorkerEffect

FINE, STRETCHED, REFUSED = "fine", "stretched", "refused"
MOST_SQUARE = {FINE: 9.0, STRETCHED: 36.0}
"""Squared Mahalanobis distance for each number that a target says, up to which it is fine, or stretched."""
MOST_APART_M = {FINE: 0.10, STRETCHED: 0.25}
"""The same of the distance to the nearest recorded place, in metres, times the root of how many numbers are said."""
LEAST_M = 0.01
"""Recorded places are taken to vary by a centimetre at least."""
GAP_M = 0.50
"""What is stretched where recordings lie on both sides: a gap is bridged better than an edge is left."""
# Measured on made shelves (emulator.synthetic.shelf), fitted to heights of 0.8-1.2 m, of 0.5-1.4 m, of 0.3 and 1.3 m
# and of 1.0 m alone, asked at 0.1-1.8 m: within 0.10 m of a recording trunks are wrong by at most 6 degrees and times
# by 5 %, within 0.25 m by 13 degrees and 9 %, in a gap of 1.0 m by 17 degrees and 16 %.


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

    @property
    def gaps_m(self) -> list[tuple[float, float]]:
        """(low, high) between recorded heights where hardly anything was recorded, from below."""
        return gaps_m(self.places_m[:, 2])

    def gap_sentences(self) -> list[str]:
        """What becomes of heights in each gap."""
        name, heights = "hand" if self.joint == HANDS else self.joint.replace("_", " "), self.places_m[:, 2]
        said = []
        for low, high in self.gaps_m:
            n = int(np.sum((heights > low) & (heights < high)))
            found = f"only {n} of {len(heights)} recordings had a {name} there" if n else f"no {name} was recorded"
            wide = f", those from {low + GAP_M:.2f} to {high - GAP_M:.2f} m refused" if high - low > 2.0 * GAP_M else ""
            said.append(f"Between {low:.2f} and {high:.2f} m {found}: heights there are bridged from both sides{wide}.")
        return said

    def verdict(self, target: Target, worker: WorkerEffect | None = None) -> Verdict:
        """Whether a target of this joint and mark is within what is known; of a worker: with that worker's body.

        Raises ValueError for a target of another joint or mark.
        """
        here = mark_number(self.model.task, self.model.mark_names, target.mark)
        if target.joint != self.joint or self.model.mark_names[here] != self.mark:
            raise ValueError(f"{self.model.task}: found a {target}, expected one of {self.joint} at {self.mark}")
        axes = [i for i, value in enumerate(target.place) if value is not None]
        asked = np.array([value for value in target.place if value is not None], float)
        known = _this_side(self._places(worker)[:, axes], asked)
        apart = asked - known.mean(axis=0)
        spread = np.cov(known.T).reshape(len(axes), len(axes)) + LEAST_M**2 * np.eye(len(axes))
        square = float(apart @ np.linalg.solve(spread, apart))
        nearest_m = float(np.linalg.norm(known - asked, axis=1).min())
        word = self._word(square / len(axes), nearest_m / np.sqrt(len(axes)), _between(known, asked))
        return Verdict(word, square, nearest_m, self._sentence(target, word, nearest_m))

    def _word(self, square: float, nearest_m: float, between: bool) -> str:
        if square <= MOST_SQUARE[FINE] and nearest_m <= MOST_APART_M[FINE]:
            return FINE
        most_m = GAP_M if between else MOST_APART_M[STRETCHED]
        return STRETCHED if square <= MOST_SQUARE[STRETCHED] and nearest_m <= most_m else REFUSED

    def _places(self, worker: WorkerEffect | None) -> np.ndarray:
        if worker is None:
            return self.places_m
        number = mark_number(self.model.task, self.model.mark_names, self.mark)
        places = HandPlaces(self.model, (joints_of(self.model.task, self.model.skeleton, self.joint),), (number,))
        return places(recorded(self.model, worker.z), worker.scale, worker.turns)[:, 0]

    def _sentence(self, target: Target, word: str, nearest_m: float) -> str:
        said = ", ".join(f"{name.removesuffix('_m')} {v:.2f} m" for name, v in zip(AXES, target.place) if v is not None)
        low, high = self.height_m
        how = {FINE: "is within", STRETCHED: "lies a little outside of", REFUSED: "lies far outside of"}[word]
        return (
            f"{self.model.task}: {self.joint} at {self.mark} with {said} {how} what was recorded "
            f"(heights {low:.2f} to {high:.2f} m; the nearest recording is {nearest_m:.2f} m away)"
        )


def _this_side(known: np.ndarray, asked: np.ndarray) -> np.ndarray:
    """Recordings (N, R) with no gap between them and a place (R,), of those that are not strays within a gap.

    Recordings at the floor are no witnesses of how far one reaches up; in a gap both sides are.
    """
    kept = np.ones(len(known), bool)
    for along, at in zip(known.T, asked):
        for low, high in gaps_m(along):
            kept &= ((along <= low) & (at < high)) | ((along >= high) & (at > low))
    return known[kept] if kept.any() else known


def _between(known: np.ndarray, asked: np.ndarray) -> bool:
    """Whether recordings (N, R) lie on both sides of a place (R,) on each axis."""
    return bool(np.all((known.min(axis=0) <= asked) & (asked <= known.max(axis=0))))
