"""How somebody carries a head or turns out a knee: by a few degrees other than those who were recorded, all along.

A new person is like one recorded person with a little noise between people, and so is made of the few that there are.
Where these happen to agree, in how they hold a back, the next person does not. So each bone of a new person is turned
by an angle that stays the same throughout: no bone is any faster for it.

By how much is told by all bones together: of two people a single bone tells next to nothing (Smyth 2004 pools the
variances of thousands of genes so). How alike left and right are is told by all pairs: in a squat they are, in a throw
they are not. A bone in the middle is its own other side: where it is alike it bends forward and back, and does not lean
or twist (trunks of recorded people differ by 5-6 degrees forward, 2 aside).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from emulator.skeleton import Skeleton

SHARE = 0.5
"""New people's bones are turned by so much of what recorded people's bones differ by, times a size as of their law."""
GIRDLES = ("hip", "shoulder", "clavicle")
"""Bones to these are turned as mirror images: one side alone would twist the trunk (recorded 2 degrees, else 5-8)."""
MIRRORED = np.array([-1.0, 1.0, -1.0])
"""A turn seen in the mirror of left and right: bending stays, leaning and twisting go the other way."""


@dataclass(frozen=True, eq=False)
class StreamPosition:
    """Where a generator stands: times are drawn as they would be without turns, and turns when they are asked for."""

    bits: type
    state: Any

    @classmethod
    def of(cls, rng: np.random.Generator) -> StreamPosition:
        return cls(type(rng.bit_generator), rng.bit_generator.state)

    @property
    def number(self) -> int:
        """The number that it draws next, which as a seed begins a stream that has nothing to do with its own."""
        bits = self.bits(0)
        bits.state = self.state
        return int(np.random.Generator(bits).integers(2**63))


@dataclass(frozen=True, eq=False)
class LazyArray:
    """An array that is made when it is first asked for; rows of it are, too."""

    make: Callable[[], np.ndarray]

    @cached_property
    def made(self) -> np.ndarray:
        """The array."""
        return self.make()

    def __getitem__(self, rows: Any) -> np.ndarray | LazyArray:
        return self.made[rows] if "made" in self.__dict__ else LazyArray(partial(_rows, self, rows))


def _rows(whole: LazyArray, rows: Any) -> np.ndarray:
    return np.asarray(whole.made[rows])


@dataclass(frozen=True)
class BoneTurns:
    """spread_rad : standard deviation along an axis of how a middling bone points, between people of one kind
    alike : correlation of left and right, 0 to 1; upright : of bones in the middle and their mirror image
    """

    spread_rad: float = 0.0
    alike: float = 0.0
    upright: float = 0.0

    @classmethod
    def fit(cls, directions: np.ndarray, worker: np.ndarray, kind: np.ndarray, skeleton: Skeleton) -> BoneTurns:
        """From mean vectors of each bone in each repetition (N, B, 3), worker (N,) and the kinds (W,) of these.

        Nothing is turned where no two people are of one kind.
        """
        from scipy.special import chdtri

        points = directions / np.maximum(np.linalg.norm(directions, axis=-1, keepdims=True), 1e-12)
        people = np.stack([points[worker == w].mean(axis=0) for w in range(len(kind))])
        means = np.stack([people[kind == k].mean(axis=0) for k in kind])
        apart = people - means
        free = 2 * (len(kind) - len(np.unique(kind)))  # two axes each
        if free == 0:
            return NO_TURNS
        middling = np.median(np.sum(apart**2, axis=(0, 2)))
        turns = np.cross(means, apart)
        left, right, middle = _sides(skeleton)
        alike, upright = _alike(turns[:, left], turns[:, right]), _alike(turns[:, middle], turns[:, middle])
        return cls(float(np.sqrt(middling / chdtri(free, 0.5))), alike, upright)

    @property
    def said(self) -> str:
        """How new people's bones point, in words."""
        if not self.spread_rad > 0:
            return "point as the movement has them"
        degrees = np.degrees(SHARE * self.spread_rad)
        alike = f"left and right alike to {100 * self.alike:.0f} %, trunk and head to {100 * self.upright:.0f} %"
        return f"point {degrees:.2g} degrees another way throughout (standard deviation along an axis), {alike}"

    def drawn(self, n: int, sizes: np.ndarray, skeleton: Skeleton, seed: StreamPosition | np.ndarray) -> np.ndarray:
        """(n, B, 3) rotation vectors, radians, of n new people, each of one of the sizes (A,)."""
        rng = np.random.default_rng(seed.number if isinstance(seed, StreamPosition) else seed)
        size = rng.choice(sizes, n)[:, None, None]
        unit = rng.standard_normal((n, skeleton.n_bones, 3))
        left, right, middle = _sides(skeleton)
        girdle = [skeleton.bone_names[bone].endswith(GIRDLES) for bone in left]
        alike = np.where(girdle, 1.0, self.alike)[:, None]
        unit[:, right] = alike * MIRRORED * unit[:, left] + np.sqrt(1.0 - alike**2) * unit[:, right]
        unit[:, middle] *= np.sqrt(1.0 + self.upright * MIRRORED)
        return np.asarray(SHARE * self.spread_rad * size * unit)


NO_TURNS = BoneTurns()


def _alike(turns: np.ndarray, others: np.ndarray) -> float:
    """Correlation of turns (W, P, 3) with the mirror images of others (W, P, 3), at least 0; 0 where nothing turns."""
    square = 0.5 * np.sum(turns**2 + others**2)
    return float(np.clip(np.sum(turns * others * MIRRORED) / square, 0.0, 1.0)) if square > 0 else 0.0


def _sides(skeleton: Skeleton) -> tuple[list[int], list[int], list[int]]:
    """Bones of one side that have another on the other side, these, and those in the middle."""
    pairs = [(one, other) for one, other in enumerate(skeleton.other_side) if one <= other]
    left, right = ([pair[side] for pair in pairs if pair[0] < pair[1]] for side in (0, 1))
    return left, right, [one for one, other in pairs if one == other]
