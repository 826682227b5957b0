"""Synthesis: a cycle repeated, units joined at common postures with continuous speed.

Source: spatio-temporal LTSA, end of sec. 4. The joining itself is ``emulator.composite.joining``.

New frames onto the manifold and back, by the affine map of the neighbourhood they fall into.

Source: spatio-temporal LTSA, sec. 2.4: what maps a frame's neighbours maps what lies close to it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from emulator.composite.joining import BLEND_S, joined
from emulator.motion import Motion, motion_from_positions
from emulator.recordings.take import Take
from emulator.segmenting.ltsa import Embedding
from emulator.skeleton import Skeleton

ALIKE_RAD, MOST_RAD = 0.05, 0.25
"""Postures are one and the same within the first, and too far apart to be joined beyond the second."""
MOST_COMPARED = 2000
"""Frames of each motion that are compared; of longer ones every second, third, ..."""


def motion_of(take: Take, start: int = 0, stop: int | None = None) -> Motion:
    """Frames ``start`` to ``stop``, both within, of a take as a motion. Raises ValueError for fewer than two frames."""
    last = take.n_frames - 1 if stop is None else stop
    if not 0 <= start < last < take.n_frames:
        raise ValueError(f"take {take.name}: found frames {start} to {last}, expected two or more of {take.n_frames}")
    assert take.parents is not None
    return motion_from_positions(
        Skeleton(take.names, take.parents),
        take.positions_m[start : last + 1],
        take.rate_hz,
        worker=take.worker,
        trial=take.trial,
        covariates=take.covariates,
    )


def take_of(motion: Motion, rate_hz: float) -> Take:
    """A motion as a take with even frames, where it was recorded. Its end is kept within half a frame."""
    n_frames = round(motion.duration_s * rate_hz) + 1
    positions = motion.positions_m(world=True)
    at = np.arange(n_frames) / rate_hz
    shape = (n_frames, *positions.shape[1:])
    flat = positions.reshape(len(positions), -1)
    if len(positions) == n_frames and np.allclose(motion.time_s, at):
        even = positions
    else:
        from scipy.interpolate import CubicSpline

        even = CubicSpline(motion.time_s, flat)(np.minimum(at, motion.duration_s)).reshape(shape)
    return Take(motion.skeleton.names, motion.skeleton.parents, even, rate_hz, motion.worker, motion.trial)


def repeated(cycle: Motion, times: int, *, blend_s: float = BLEND_S) -> Motion:
    """A cycle ``times`` times, its start joined to its end; ``times`` as long as one. Raises ValueError below one."""
    if times < 1:
        raise ValueError(f"repeated: found {times} times, expected 1 or more")
    return joined([cycle] * times, blend_s=blend_s)


def common_postures(before: Motion, after: Motion, most_rad: float = MOST_RAD) -> tuple[int, int, float]:
    """The frames (of ``before``, of ``after``) at which two motions are alike in posture and speed, and how far apart.

    Apart: root mean square over bones of the chord, and of that which the difference in speed makes in 0.05 s. Of all
    pairs within ALIKE_RAD (else of those about as near as the nearest) the one that keeps most of both.
    Raises ValueError where no two frames are within ``most_rad``: there is no common posture to join them at.
    """
    from scipy.spatial.distance import cdist

    thin, thinner = (-(-len(motion.time_s) // MOST_COMPARED) for motion in (before, after))
    apart = cdist(_state(before)[::thin], _state(after)[::thinner]) / np.sqrt(before.skeleton.n_bones)
    least = float(apart.min())
    if least > most_rad:
        raise ValueError(
            f"{before.name} and {after.name} have no posture in common: the nearest two are "
            f"{np.degrees(least):.0f} degrees apart, expected at most {np.degrees(most_rad):.0f}"
        )
    one, other = np.nonzero(apart <= max(ALIKE_RAD, 1.2 * least))
    best = int(np.argmax(one - other))
    return int(one[best]) * thin, int(other[best]) * thinner, float(apart[one[best], other[best]])


def joined_at_common_posture(
    units: Sequence[Motion], *, blend_s: float = BLEND_S, most_rad: float = MOST_RAD
) -> Motion:
    """Units one after the other, each left and the next entered where the two are most alike. Raises as above."""
    parts = list(units)
    for i in range(len(parts) - 1):
        leave, enter, _ = common_postures(parts[i], parts[i + 1], most_rad)
        parts[i], parts[i + 1] = part(parts[i], 0, max(leave, 1)), part(parts[i + 1], enter, None)
    return joined(parts, blend_s=blend_s)


def part(motion: Motion, start: int, stop: int | None) -> Motion:
    """Frames ``start`` to ``stop``, both within, of a motion; at least two."""
    last = len(motion.time_s) - 1 if stop is None else stop
    start = min(start, last - 1)
    positions = motion.positions_m(world=True)[start : last + 1]
    cut = motion_from_positions(
        motion.skeleton, positions, 1.0, worker=motion.worker, trial=motion.trial, covariates=motion.covariates
    )
    return replace(cut, time_s=motion.time_s[start : last + 1] - motion.time_s[start])


def _state(motion: Motion) -> np.ndarray:
    """(T, 6 B): directions, and how far they come in 0.05 s at their speed."""
    speed = np.gradient(motion.directions, motion.time_s, axis=0)
    return np.concatenate([motion.directions, 0.05 * speed], axis=1).reshape(len(motion.time_s), -1)


def to_manifold(embedding: Embedding, points: np.ndarray, near_frame: np.ndarray | None = None) -> np.ndarray:
    """Coordinates (p, d) of new points (p, m).

    near_frame : (p,) frames of the embedding, also between frames, that each lies next to in time;
                 None: the nearest in space is taken
    """
    nearest = _nearest(embedding.points, points, near_frame)
    return _mapped(embedding, points, nearest, embedding.points, embedding.coordinates, embedding.d)


def to_postures(embedding: Embedding, coordinates: np.ndarray, near_frame: np.ndarray | None = None) -> np.ndarray:
    """Points (p, m) of posture space at coordinates (p, d) on the manifold."""
    nearest = _nearest(embedding.coordinates, coordinates, near_frame)
    return _mapped(embedding, coordinates, nearest, embedding.coordinates, embedding.points, embedding.d)


def _nearest(known: np.ndarray, new: np.ndarray, near_frame: np.ndarray | None) -> np.ndarray:
    if near_frame is not None:
        return np.clip(np.rint(near_frame).astype(int), 0, len(known) - 1)
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(known).query(new)[1])


def _mapped(
    embedding: Embedding, new: np.ndarray, nearest: np.ndarray, source: np.ndarray, target: np.ndarray, d: int
) -> np.ndarray:
    """The least-squares affine map from ``source`` to ``target`` on each neighbourhood, through its own frame."""
    found = np.empty((len(new), target.shape[1]))
    for frame in np.unique(nearest):
        members = np.append(embedding.neighbours[frame], frame)
        here, there = source[members], target[members]
        left, size, right = np.linalg.svd(here - source[frame], full_matrices=False)
        keep = min(d, int(np.sum(size > 1e-10 * max(float(size[0]), 1e-300))))
        inverse = (left[:, :keep] / size[:keep]).T @ (there - target[frame])
        rows = nearest == frame
        found[rows] = target[frame] + (new[rows] - source[frame]) @ right[:keep].T @ inverse
    return found
