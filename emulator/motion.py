"""Tables as data frames of pandas, which is needed for nothing else and imported when it is asked for.

What is taken out of a recording before it is modelled: the heading, and repetitions that no body can do.

Heading: directions turn with the body, so the yaw of the body is removed frame by frame and kept as a side channel.
Body frame (z up): y along the levelled hip line to the left, x = y cross up, forward. The hip line is
taken between the unit directions to both hips, so that the heading, as the posture, does not know the lengths of bones.

Motion: one repetition of a task by one worker. MotionSet: the repetitions of one task. Frozen data.

A motion is split into posture (unit directions, heading removed) and three side channels from which the world
positions come back: the heading, the root's path, the bone lengths.

Runs of frames.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from emulator.skeleton import Skeleton

HOW = "to_frame() needs pandas, which is not installed; 'pip install opsim[frames]' gets it"


def frame(columns: Mapping[str, Any]) -> Any:
    """A pandas DataFrame of columns by name. Raises ImportError that says what to install, where pandas is absent."""
    try:
        from pandas import DataFrame
    except ImportError:
        raise ImportError(HOW) from None
    return DataFrame(dict(columns))


IMPOSSIBLE_M_PER_S = 13.0
"""No joint of a working or exercising person is faster: above, a marker has jumped. A jump below it passes unseen."""
LYING_SHARE = 0.2
"""Where the levelled hip line is shorter than this share of it, the heading is bridged from the frames around."""


def turn(vectors: np.ndarray, yaw_rad: np.ndarray | float) -> np.ndarray:
    """The vectors (..., 3) turned by ``yaw_rad`` (broadcast against (...)) about the vertical, x towards y."""
    cosine, sine = np.cos(yaw_rad), np.sin(yaw_rad)
    x, y, z = np.moveaxis(np.asarray(vectors, float), -1, 0)
    return np.stack(np.broadcast_arrays(cosine * x - sine * y, sine * x + cosine * y, z), axis=-1)


def heading_rad(skeleton: Skeleton, positions: np.ndarray) -> np.ndarray:
    """Unwrapped yaw (T,) of the body over the frames (T, J, 3): 0 looks along x, pi/2 along y.

    Where the hip line stands upright (lying on a side) the yaw is interpolated from the frames around.
    Raises ValueError where the skeleton has no hips, or never a level hip line.
    """
    directions, bones = skeleton.directions(positions), skeleton.bone_names
    left, right = (bones.index(skeleton.names[skeleton.index(f"{side}_hip")]) for side in ("left", "right"))
    hips = directions[:, left] - directions[:, right]
    level = np.hypot(hips[:, 0], hips[:, 1])
    clear = np.flatnonzero(level > LYING_SHARE * np.linalg.norm(hips, axis=-1))
    if clear.size == 0:
        raise ValueError("heading: the hip line is never level; the body has no heading")
    yaw = np.unwrap(np.arctan2(-hips[clear, 0], hips[clear, 1]))
    return np.interp(np.arange(len(positions)), clear, yaw)


def top_speed_m_per_s(positions: np.ndarray, rate_hz: float) -> float:
    """The greatest speed of any joint between two frames of (T, J, 3)."""
    return float(np.linalg.norm(np.diff(positions, axis=0), axis=-1).max() * rate_hz)


def glitch(
    positions: np.ndarray, rate_hz: float, limit_m_per_s: float = IMPOSSIBLE_M_PER_S, names: Sequence[str] = ()
) -> str:
    """Why a repetition (T, J, 3) cannot be a body's movement, or "" if nothing speaks against it.

    names : of the joints; with them the first joint and time are told
    """
    missing = np.argwhere(~np.isfinite(positions).all(axis=-1))
    if len(missing):
        frame, joint = missing[0]
        where = f": {names[joint]} at frame {frame} ({frame / rate_hz:.2f} s)" if names else ""
        more = f", and {len(missing) - 1} more" if where and len(missing) > 1 else ""
        return f"positions are missing{where}{more}"
    if top_speed_m_per_s(positions, rate_hz) <= limit_m_per_s:
        return ""
    speed = np.linalg.norm(np.diff(positions, axis=0), axis=-1) * rate_hz
    frame, joint = np.unravel_index(speed.argmax(), speed.shape)
    where = f": {names[joint]} from frame {frame} to {frame + 1} ({(frame + 1) / rate_hz:.2f} s)" if names else ""
    return f"a joint moves at {speed.max():.1f} m/s (at most {limit_m_per_s:g}){where}"


@dataclass(frozen=True, eq=False)
class Motion:
    """One repetition, from its first to its last frame.

    directions    : (T, B, 3) unit vectors, heading removed frame by frame
    time_s        : (T,) from 0, increasing; duration_s is its last entry
    root_m        : (T, 3) path of the root in the frame of the starting heading, from x = y = 0; z is the height
    yaw_rad       : (T,) the removed heading from 0 at the start, unwrapped
    bone_length_m : (B,) median over the frames
    mark_s        : (E,) seconds of the marks of the MotionSet
    start_m, start_yaw_rad : where it began in the recording, (2,) and the heading; not part of any model
    stretch       : (T, B) recorded bone length over its median (surface markers slide on the skin), or None
    """

    skeleton: Skeleton
    directions: np.ndarray
    time_s: np.ndarray
    root_m: np.ndarray
    yaw_rad: np.ndarray
    bone_length_m: np.ndarray
    mark_s: np.ndarray
    worker: str
    trial: str
    covariates: Mapping[str, Any] = field(default_factory=dict)
    start_m: np.ndarray = field(default_factory=lambda: np.zeros(2))
    start_yaw_rad: float = 0.0
    stretch: np.ndarray | None = None

    def __post_init__(self) -> None:
        n_times, n_bones = len(self.time_s), self.skeleton.n_bones
        shapes = {
            "directions": (n_times, n_bones, 3),
            "root_m": (n_times, 3),
            "yaw_rad": (n_times,),
            "bone_length_m": (n_bones,),
        }
        for name, shape in shapes.items():
            if np.shape(getattr(self, name)) != shape:
                raise ValueError(f"motion {self.name}: {name} must be {shape}, found {np.shape(getattr(self, name))}")
        if n_times < 2 or self.time_s[0] != 0 or not np.all(np.diff(self.time_s) > 0):
            raise ValueError(f"motion {self.name}: time_s must have two frames or more, start at 0 and increase")

    @property
    def name(self) -> str:
        return f"{self.worker}/{self.trial}"

    @property
    def duration_s(self) -> float:
        return float(self.time_s[-1])

    def positions_m(self, *, world: bool = False, rigid: bool = True) -> np.ndarray:
        """Joint positions (T, J, 3) in the frame of the start, or in the recording's (``world``).

        ``rigid=False`` lets the bones breathe as recorded: with ``world`` these are the recorded positions.
        """
        yaw = self.yaw_rad + (self.start_yaw_rad if world else 0.0)
        root = self.root_m
        if world:
            root = turn(root, self.start_yaw_rad) + np.append(self.start_m, 0.0)
        length_m = self.bone_length_m if rigid or self.stretch is None else self.bone_length_m * self.stretch
        return self.skeleton.positions(turn(self.directions, yaw[:, None]), length_m, root)

    def _repr_html_(self) -> str:
        from emulator.notebook import motion_html

        return motion_html(self)


def motion_from_positions(
    skeleton: Skeleton,
    positions_m: np.ndarray,
    rate_hz: float,
    *,
    worker: str,
    trial: str,
    mark_s: Sequence[float] | np.ndarray = (),
    covariates: Mapping[str, Any] | None = None,
) -> Motion:
    """Split joint positions (T, J, 3), z up, at ``rate_hz`` frames a second into posture, heading, path and bones.

    Raises ValueError that names joint and frame for a bone without length or a position that is not finite.
    """
    positions_m = np.asarray(positions_m, float)
    world, length_m = skeleton.directions(positions_m), skeleton.bone_lengths(positions_m)
    bone_m = np.median(length_m, axis=0)
    heading = heading_rad(skeleton, positions_m)
    root = positions_m[:, skeleton.root]
    origin = np.append(root[0, :2], 0.0)
    return Motion(
        skeleton=skeleton,
        directions=turn(world, -heading[:, None]),
        time_s=np.arange(len(positions_m)) / float(rate_hz),
        root_m=turn(root - origin, -heading[0]),
        yaw_rad=heading - heading[0],
        bone_length_m=bone_m,
        mark_s=np.asarray(mark_s, float),
        worker=str(worker),
        trial=str(trial),
        covariates=dict(covariates or {}),
        start_m=origin[:2],
        start_yaw_rad=float(heading[0]),
        stretch=length_m / bone_m,
    )


@dataclass(frozen=True, eq=False)
class MotionSet:
    """The repetitions of one task, all of one skeleton; ``notes`` say what was repaired or left out.

    ``selection`` is the expression by which they were chosen ("all" if none). Raises ValueError for an empty set,
    mixed skeletons, or a motion whose marks do not fit ``mark_names``.
    """

    task: str
    motions: tuple[Motion, ...]
    mark_names: tuple[str, ...] = ()
    source: str = ""
    licence: str = ""
    notes: tuple[str, ...] = ()
    selection: str = "all"

    def __post_init__(self) -> None:
        object.__setattr__(self, "motions", tuple(self.motions))
        if not self.motions:
            raise ValueError(f"{self.task}: no repetition is left (selection: {self.selection})")
        for motion in self.motions:
            if motion.skeleton != self.skeleton:
                odd = sorted(set(motion.skeleton.names) ^ set(self.skeleton.names))
                how = f"only one has {', '.join(odd[:6])}" if odd else "its joints hang or are ordered otherwise"
                raise ValueError(
                    f"{self.task}: motion {motion.name} has another skeleton than {self.motions[0].name}: {how}"
                )
            if len(motion.mark_s) != len(self.mark_names):
                raise ValueError(
                    f"{self.task}: motion {motion.name} has {len(motion.mark_s)} marks, not {len(self.mark_names)}"
                )

    def __len__(self) -> int:
        return len(self.motions)

    @property
    def skeleton(self) -> Skeleton:
        return self.motions[0].skeleton

    @property
    def workers(self) -> tuple[str, ...]:
        """The workers, each once, in natural order (w2 before w10)."""
        return tuple(sorted({motion.worker for motion in self.motions}, key=_natural))

    @property
    def worker_index(self) -> np.ndarray:
        """(N,) number of each motion's worker in ``workers``."""
        number = {name: i for i, name in enumerate(self.workers)}
        return np.array([number[motion.worker] for motion in self.motions])

    @property
    def duration_s(self) -> np.ndarray:
        """(N,) seconds."""
        return np.array([motion.duration_s for motion in self.motions])

    @property
    def mark_s(self) -> np.ndarray:
        """(N, E) seconds."""
        return np.array([motion.mark_s for motion in self.motions]).reshape(len(self), len(self.mark_names))

    def where(self, condition: str | Callable[[Motion], bool]) -> MotionSet:
        """Motions that fulfil an expression such as ``"cov_correct == 1 and worker in (s01, s02)"``, or a predicate."""
        if callable(condition):
            return self.subset([i for i, motion in enumerate(self.motions) if condition(motion)], "a predicate")
        from emulator.recordings.selection import rows_where

        keep = rows_where(condition, table_of(self.motions))
        return self.subset(np.flatnonzero(keep), condition)

    def in_order(self) -> MotionSet:
        """The same motions by worker and trial in natural order, then duration: the order of a file decides nothing."""
        return replace(self, motions=tuple(sorted(self.motions, key=_place)))

    def subset(self, indices: Sequence[int] | np.ndarray, selection: str = "") -> MotionSet:
        """The motions of these numbers, in this order."""
        said = [part for part in (self.selection if self.selection != "all" else "", selection) if part]
        chosen = tuple(self.motions[int(i)] for i in indices)
        return replace(
            self,
            motions=chosen,
            selection=" and ".join(f"({p})" for p in said) if len(said) > 1 else (said or ["all"])[0],
        )

    def to_frame(self) -> Any:
        """A pandas DataFrame, a row each: worker, trial, duration, covariates. Raises ImportError without pandas."""
        pass

        return frame(table_of(self.motions))

    def _repr_html_(self) -> str:
        from emulator.notebook import motion_set_html

        return motion_set_html(self)


def table_of(motions: Sequence[Motion]) -> dict[str, list[Any]]:
    """The columns by which motions can be chosen: worker, trial, duration and the covariates that all have."""
    shared = set.intersection(*(set(motion.covariates) for motion in motions)) if motions else set()
    columns: dict[str, list[Any]] = {name: [motion.covariates[name] for motion in motions] for name in sorted(shared)}
    columns["worker"] = [motion.worker for motion in motions]
    columns["trial"] = [motion.trial for motion in motions]
    columns["duration_s"] = [motion.duration_s for motion in motions]
    return columns


def _place(motion: Motion) -> tuple[Any, ...]:
    return _natural(motion.worker), _natural(motion.trial), motion.duration_s


def _natural(name: str) -> list[tuple[int, int, str]]:
    parts = re.split(r"(\d+)", name)
    return [(0, int(p), "") if p.isdigit() else (1, 0, p) for p in parts if p]


def stretches(true: np.ndarray) -> list[tuple[int, int]]:
    """(start, stop) of each run of true values in (T,), stop one beyond its last frame."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(true, int), [0]])))
    return [(int(start), int(stop)) for start, stop in zip(edges[::2], edges[1::2])]
