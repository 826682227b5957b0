"""Movements as a camera sees them: places of joints at even times of real time, of recordings and of draws alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.model.feet import on_its_feet
from emulator.model.performances import MotionPerformances
from emulator.motion import Motion, MotionSet
from emulator.skeleton import Skeleton

FEWEST_TIMES = 4
"""A third difference needs so many; a shorter clip is read on so many points."""


@dataclass(frozen=True, eq=False)
class Clips:
    """n movements of one skeleton.

    positions_m : n arrays (T, J, 3), metres, z up, at even times from 0 to the clip's duration, T its own
    duration_s  : (n,) seconds
    Raises ValueError that names the clip for what is not finite, of another skeleton, or without time.
    """

    skeleton: Skeleton
    positions_m: tuple[np.ndarray, ...]
    duration_s: np.ndarray

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions_m", tuple(np.asarray(p, float) for p in self.positions_m))
        object.__setattr__(self, "duration_s", np.asarray(self.duration_s, float))
        if len(self.positions_m) != len(self.duration_s) or not len(self.duration_s):
            raise ValueError(f"clips: found {len(self.positions_m)} movements and {len(self.duration_s)} durations")
        for i, (positions, seconds) in enumerate(zip(self.positions_m, self.duration_s)):
            expected = self.skeleton.n_joints, 3
            if positions.ndim != 3 or positions.shape[1:] != expected or len(positions) < 2:
                raise ValueError(f"clip {i}: found {positions.shape}, expected (T, {expected[0]}, 3), T from 2")
            if not (np.isfinite(seconds) and seconds > 0):
                raise ValueError(f"clip {i}: found a duration of {seconds} s, expected more than 0")
            if not np.isfinite(positions).all():
                frame, joint = np.argwhere(~np.isfinite(positions).all(axis=-1))[0]
                raise ValueError(f"clip {i}: joint {self.skeleton.names[joint]!r} is not finite at frame {frame}")

    def __len__(self) -> int:
        return len(self.duration_s)

    def __getitem__(self, rows: np.ndarray | Sequence[int] | slice) -> Clips:
        """The clips of a slice or of these numbers, in this order."""
        at = np.arange(len(self))[rows]
        return Clips(self.skeleton, tuple(self.positions_m[i] for i in at), self.duration_s[at])

    @classmethod
    def recorded(cls, motions: MotionSet, skeleton: Skeleton | None = None, *, rigid: bool = True) -> Clips:
        """Recordings, each in the frame of its start, at its own frames.

        skeleton : whose joints to keep (an emulator may have fewer than the recording); None: all
        rigid    : with bones of one length, as a draw has them, on the feet where they were recorded; False: as
                   recorded, where markers on the skin make bones that breathe
        """
        keep = _kept(motions.skeleton, skeleton)
        places = tuple(_even_frames(motion, rigid)[:, keep] for motion in motions.motions)
        return cls(skeleton or motions.skeleton, places, motions.duration_s)

    @classmethod
    def drawn(cls, performances: MotionPerformances, rate_hz: float) -> Clips:
        """Performances decoded at about ``rate_hz`` frames a second: take the rate of the recordings beside them."""
        places = []
        for i, seconds in enumerate(performances.duration_s):
            n_times = max(FEWEST_TIMES, round(float(seconds) * rate_hz) + 1)
            places.append(performances[i].positions_m(n_times=n_times)[0])
        return cls(performances.skeleton, tuple(places), performances.duration_s)

    def at_rate(self, rate_hz: float) -> tuple[list[np.ndarray], np.ndarray]:
        """Positions (T, J, 3) of each clip at about ``rate_hz``, linear between frames, and their steps (n,) in s.

        The last point is the last frame, so the step is within half a step in the whole duration of 1 / rate_hz.
        """
        n_times = np.maximum(np.round(self.duration_s * rate_hz).astype(int) + 1, FEWEST_TIMES)
        places = [resampled(p, int(n)) for p, n in zip(self.positions_m, n_times)]
        return places, self.duration_s / (n_times - 1)


def frame_rate_hz(motions: MotionSet) -> float:
    """Frames a second of recordings: the middle one's."""
    return float(np.median([(len(motion.time_s) - 1) / motion.duration_s for motion in motions.motions]))


def resampled(frames: np.ndarray, n_times: int) -> np.ndarray:
    """Frames (T, ...) at even times as (n_times, ...), linear between; the first and the last stay."""
    place = np.linspace(0, len(frames) - 1, n_times)
    cell = np.minimum(place.astype(int), len(frames) - 2)
    share = (place - cell).reshape(-1, *[1] * (frames.ndim - 1))
    return np.asarray(frames[cell] + share * (frames[cell + 1] - frames[cell]))


def _kept(theirs: Skeleton, ours: Skeleton | None) -> list[int]:
    if ours is None:
        return list(range(theirs.n_joints))
    absent = [name for name in ours.names if name not in theirs.names]
    if absent:
        raise ValueError(f"clips: the recordings have no joint {absent[0]!r}; they have {', '.join(theirs.names)}")
    return [theirs.names.index(name) for name in ours.names]


def _even_frames(motion: Motion, rigid: bool) -> np.ndarray:
    """(T, J, 3) of a recording at even times; frames lost in it are filled linearly."""
    standing = on_its_feet(motion) if rigid else motion
    positions, time_s = standing.positions_m(rigid=rigid), motion.time_s
    even = np.linspace(0.0, time_s[-1], len(time_s))
    if np.allclose(even, time_s, atol=1e-6 * time_s[-1]):
        return positions
    flat = positions.reshape(len(positions), -1)
    return np.stack([np.interp(even, time_s, column) for column in flat.T], axis=1).reshape(positions.shape)
