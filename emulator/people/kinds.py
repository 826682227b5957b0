"""Kinds of people: who does a task with the other hand, or steps with the other foot, has no mean with the rest.

Two people do it on different sides if the mirror image of one mean movement is much nearer to the other one than the
movement itself is. New people then do it on one of the sides, as often as recorded ones do, and differ from those of
that side as people of one side do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.geometry.alignment import resample
from emulator.motion import MotionSet
from emulator.skeleton import Skeleton

N_TIMES = 31
NEARER = 0.6
"""Of those on the other side a mirror image is at most so much as far. Of four who lunge one steps with the other foot:
.40 to .44 to the others; of all other pairs in 13 classes of recordings .80 and more, of no side about 1."""


@dataclass(frozen=True, eq=False)
class Kinds:
    """of : (W,) the kind of each person, numbered from 0

    means : (W, K) the mean of each one's kind less that of all; 0 in coordinates that do not depend on the kind
    """

    of: np.ndarray
    means: np.ndarray

    @classmethod
    def fit(cls, of: np.ndarray, people: np.ndarray, differ: np.ndarray) -> Kinds:
        """Of the people's means (W, K), in the coordinates that ``differ`` (K,) by kind."""
        means = np.stack([people[of == kind].mean(axis=0) for kind in range(of.max() + 1)])
        return cls(of, np.where(differ, means[of] - people.mean(axis=0), 0.0))

    @property
    def several(self) -> bool:
        """Whether there is more than one."""
        return bool(self.of.any())

    @property
    def n_free(self) -> int:
        """People that tell how people of one kind differ: one is lost for each kind but the first."""
        return len(self.of) - int(self.of.max())

    @property
    def lost(self) -> np.ndarray:
        """(K,) degrees of freedom that the kinds' means cost."""
        return self.of.max() * self.means.any(axis=0)

    @property
    def differing(self) -> np.ndarray:
        """(K,) people who differ from the mean of their kind: not those who are alone of it."""
        count = np.bincount(self.of)
        together = int(count[count > 1].sum()) if self.several else len(self.of)
        return np.where(self.means.any(axis=0), together, len(self.of))


def kinds_of(motions: MotionSet) -> np.ndarray:
    """(W,) the kind of each worker, numbered from 0, by the mean of the worker's movements along their own time.

    Kinds are the parts that hang together by pairs on the same side (single linkage). All are of one kind where nobody
    shares his with another one, so that nothing tells how people of one kind differ; or in a body without sides.
    """
    from scipy.sparse.csgraph import connected_components

    along = np.linspace(0.0, 1.0, N_TIMES)
    rows = np.stack([resample(motion.directions, along) for motion in motions.motions])
    means = np.stack([rows[motions.worker_index == w].mean(axis=0) for w in range(len(motions.workers))])
    unit = means / np.maximum(np.linalg.norm(means, axis=-1, keepdims=True), 1e-12)
    image = unit[:, :, _other_side(motions.skeleton)] * np.array([1.0, -1.0, 1.0])
    straight, crossed = (_apart(unit, other) for other in (unit, image))
    _, kinds = connected_components(crossed >= NEARER * straight, directed=False)
    return np.asarray(kinds) if np.bincount(kinds).max() > 1 else np.zeros(len(unit), int)


def _other_side(skeleton: Skeleton) -> list[int]:
    """For each bone that of the other side; itself in the middle, or where the other side is not there."""
    names = skeleton.bone_names
    swapped = {"left_": "right_", "right_": "left_"}
    other = [next((to + n[len(side) :] for side, to in swapped.items() if n.startswith(side)), n) for n in names]
    return [names.index(one) if one in names else i for i, one in enumerate(other)]


def _apart(these: np.ndarray, those: np.ndarray) -> np.ndarray:
    """(W, W) root mean square angles between movements (W, T, B, 3) of unit vectors."""
    cosines = np.einsum("atbc,utbc->autb", these, those)
    return np.asarray(np.sqrt(np.mean(np.arccos(np.clip(cosines, -1.0, 1.0)) ** 2, axis=(2, 3))))
