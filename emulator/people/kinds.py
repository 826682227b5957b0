"""Kinds of people: with those who do a task with the other hand or foot, the others have a mean that nobody makes.

Two people do it on different sides if the mirror image of one mean movement is much nearer to the other one than the
movement itself is. New people then do it on one of the sides, as often as recorded ones do, and differ from those of
that side as people of one side do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.geometry.flattening import resample
from emulator.motion import MotionSet

N_TIMES = 31
NEARER = 0.6
"""Of people on different sides a mirror image is at most 0.6 times as far from the other's movement as the movement is.
Of four who lunge one steps with the other foot: .42 to .46; all other pairs in 13 classes of recordings have .82 and
more, movements without a side about 1."""
LEAST = 2.0 * np.sin(np.radians(5.0))
"""Movements nearer to each other than a chord of 10 degrees, root mean square over bones and time, are of one kind: who
lunges with the other foot is 34 degrees away, people of one kind are 7-30 from each other."""


@dataclass(frozen=True, eq=False)
class Kinds:
    """of : (W,) the kind of each person, numbered from 0

    shift  : (W, K) the mean of each one's kind less that of all; 0 in coordinates that do not differ by kind
    differ : (K,) which coordinates do
    """

    of: np.ndarray
    shift: np.ndarray
    differ: np.ndarray

    @classmethod
    def fit(cls, of: np.ndarray, people: np.ndarray, differ: np.ndarray) -> Kinds:
        """Of the people's means (W, K)."""
        kinds = cls(of, np.zeros_like(people), differ & bool(of.any()))
        return cls(of, kinds.shifts(people), kinds.differ)

    @classmethod
    def one(cls, n_people: int, n_coordinates: int) -> Kinds:
        """All are of one kind."""
        return cls(np.zeros(n_people, int), np.zeros((n_people, n_coordinates)), np.zeros(n_coordinates, bool))

    def shifts(self, rows: np.ndarray) -> np.ndarray:
        """(W, K) the mean of each one's kind less that of all, of rows (W, K), in the coordinates that differ."""
        means = np.stack([rows[self.of == kind].mean(axis=0) for kind in range(self.of.max() + 1)])
        return np.where(self.differ, means[self.of] - rows.mean(axis=0), 0.0)

    @property
    def several(self) -> bool:
        """Whether there is more than one."""
        return bool(self.of.any())

    @property
    def most_frequent_shift(self) -> np.ndarray:
        """(K,) the shift of the kind of most people."""
        return np.asarray(self.shift[self.of == np.bincount(self.of).argmax()][0])

    @property
    def n_free(self) -> int:
        """People that tell how people of one kind differ: one is lost for each kind but the first."""
        return len(self.of) - int(self.of.max())

    @property
    def df_lost(self) -> np.ndarray:
        """(K,) degrees of freedom that the kinds' means cost."""
        return self.of.max() * self.differ

    @property
    def alone(self) -> np.ndarray:
        """(W,) who is the only one of a kind."""
        return (np.bincount(self.of) == 1)[self.of] & self.several

    @property
    def n_not_alone(self) -> np.ndarray:
        """(K,) people who deviate from the mean of their kind; all where coordinates do not differ by kind."""
        return len(self.of) - int(np.sum(self.alone)) * self.differ


def kinds_of(motions: MotionSet) -> np.ndarray:
    """(W,) the kind of each worker, numbered from 0, by the mean of the worker's movements along their own time.

    Kinds are the parts that hang together by pairs on the same side (single linkage). All are of one kind where no two
    people are on one side, so that nothing tells how people of one kind differ; or in a body without sides.
    """
    from scipy.sparse.csgraph import connected_components

    along, other_side = np.linspace(0.0, 1.0, N_TIMES), list(motions.skeleton.other_side)
    rows = np.stack([resample(motion.directions, along) for motion in motions.motions])
    index = motions.worker_index
    means = np.stack([rows[index == w].mean(axis=0) for w in range(index.max() + 1)])
    unit = means / np.maximum(np.linalg.norm(means, axis=-1, keepdims=True), 1e-12)
    straight, crossed = (_apart(unit, them) for them in (unit, unit[:, :, other_side] * np.array([1.0, -1.0, 1.0])))
    one_side = (crossed >= NEARER * straight) | (straight < LEAST)
    _, kinds = connected_components(one_side, directed=False)
    sides = other_side != list(range(len(other_side)))
    return np.asarray(kinds) if sides and np.bincount(kinds).max() > 1 else np.zeros(len(unit), int)


def _apart(these: np.ndarray, those: np.ndarray) -> np.ndarray:
    """(W, W) root mean square chords between movements (W, T, B, 3) of unit vectors; radians where they are small."""
    one, other = (movements.reshape(len(movements), -1) for movements in (these, those))
    cosine = one @ other.T / (these.shape[1] * these.shape[2])
    return np.asarray(np.sqrt(np.maximum(2.0 - 2.0 * cosine, 0.0)))
