"""Recordings on their common clock: repaired, their pauses cut out, aligned with warps that the pace can say."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline

from emulator.fitting.preprocessing import repaired
from emulator.fitting.settings import CLOCK, FitSettings, Progress
from emulator.geometry import sphere
from emulator.geometry.alignment import align
from emulator.geometry.base_points import Labels
from emulator.geometry.flattening import resample
from emulator.geometry.pauses import Hold, cut
from emulator.geometry.warps import clr, from_clr
from emulator.model.decoding import RootChannel
from emulator.model.feet import on_its_feet
from emulator.model.reduction import JointPCA
from emulator.motion import Motion, MotionSet, turn

PENALTIES = (1.0, 3.0, 10.0, 30.0, 100.0)
"""Weights to choose from, in order: a tenth does nothing, at a hundred hardly anything is aligned."""
HARDLY_MORE, N_PARTNERS, STILL_M_PER_S2 = 1.1, 5, 0.01
N_ALIGNED, MOST_RATE_HZ, LEAST_RATE_HZ = 101, 60.0, 30.0
PACE_SHARE, LARGEST_PACE = 0.98, 10


@dataclass(frozen=True, eq=False)
class Registered:
    """whole : the repetitions, repaired; moving : the same without their pauses, which ``holds`` keeps

    warps : (N, T) common clock -> own unit time of moving; directions : (N, T, B, 3) postures on the common clock
    penalty : weight that held the warps near the identity
    """

    whole: MotionSet
    moving: MotionSet
    holds: tuple[tuple[Hold, ...], ...]
    warps: np.ndarray
    directions: np.ndarray
    penalty: float = 0.0

    def subset(self, mask: np.ndarray) -> Registered:
        """The repetitions of a mask (N,), on the same clock."""
        at = np.flatnonzero(mask)
        holds = tuple(self.holds[i] for i in at)
        parts = self.warps[at], self.directions[at], self.penalty
        return Registered(self.whole.subset(at), self.moving.subset(at), holds, *parts)

    def channels(self) -> np.ndarray:
        """Side channels of the root on the common clock, (N, T * 4)."""
        channel = RootChannel(self.moving.skeleton)
        rows = []
        for motion, gamma, posture in zip(self.moving.motions, self.warps, self.directions):
            root, yaw = _on_clock(motion, gamma)
            rows.append(channel.forward(posture, motion.bone_length_m, root, yaw).ravel())
        return np.stack(rows)

    def mark_clock(self, warps: np.ndarray) -> np.ndarray:
        """When the marks came on the common clock, (N, E), by these warps (N, T)."""
        clock = np.linspace(0, 1, warps.shape[1])
        rows = [np.interp(at, gamma, clock) for at, gamma in zip(_mark_share(self.moving), warps)]
        return np.stack(rows).reshape(len(self.moving), -1)


def registered(motions: MotionSet, settings: FitSettings, progress: Progress) -> Registered:
    """Motions on their feet, aligned to their common template on ``n_times`` points."""
    whole = repaired(motions)
    moving, holds = moving_of(whole)
    n_times = settings.n_times or clock_size(moving)
    penalty, warps = penalised(moving, settings, progress)
    slopes = clr(warps, settings.n_knots)
    warps = from_clr(said_by(pace_components(slopes), slopes), n_times)
    directions = np.stack([postures_at(m.directions, gamma) for m, gamma in zip(moving.motions, warps)])
    return Registered(whole, moving, holds, warps, directions, penalty)


def pace_components(slopes: np.ndarray) -> JointPCA:
    """What the log slopes (N, K) of warps vary by."""
    return JointPCA.fit(slopes, PACE_SHARE, LARGEST_PACE)


def said_by(pace: JointPCA, slopes: np.ndarray) -> np.ndarray:
    """What of log slopes (N, K) the pace can say: postures on a finer clock would not find the way back."""
    return pace.inverse(pace.forward(slopes))


def moving_of(whole: MotionSet) -> tuple[MotionSet, tuple[tuple[Hold, ...], ...]]:
    """The motions on their feet and without their pauses, and the pauses of each."""
    moving, holds = cut(whole)
    return replace(moving, motions=tuple(on_its_feet(motion) for motion in moving.motions)), holds


def clock_size(motions: MotionSet) -> int:
    """Points of the common clock: as many as a recording of the mean duration has frames at up to ``MOST_RATE_HZ``.

    And a long one, the third quartile, at up to ``LEAST_RATE_HZ``. With fewer, what trembles between them would be read
    as slow: a walk of 4 to 7 s at 30 frames a second kept .90 of its jerk by the mean alone.
    """
    rates_hz = [(len(m.time_s) - 1) / m.duration_s for m in motions.motions]
    rate_hz, long_s = float(np.median(rates_hz)), float(np.quantile(motions.duration_s, 0.75))
    n_frames = max(motions.duration_s.mean() * min(rate_hz, MOST_RATE_HZ), long_s * min(rate_hz, LEAST_RATE_HZ))
    return int(np.clip(np.ceil(n_frames) + 1, *CLOCK))


def penalised(motions: MotionSet, settings: FitSettings, progress: Progress = None) -> tuple[float, np.ndarray]:
    """The weight of the penalty on warps, and the warps (N, ``N_ALIGNED``) with it.

    Where nothing holds a warp near the identity, what differs between postures goes into the pace, harmless until a
    posture meets another's pace: then a joint may move at a multiple of anybody's speed. So recordings are given each
    other's pace and duration, and the least weight is taken at which joints accelerate hardly more than they did.
    """
    for penalty in PENALTIES if settings.penalty is None else (settings.penalty,):
        warps = _aligned_warps(motions, settings, progress, penalty)
        smooth = from_clr(clr(warps, settings.n_knots), warps.shape[1])
        if exchanged_acceleration(motions, smooth) <= HARDLY_MORE:
            break
    return penalty, warps


def exchanged_acceleration(motions: MotionSet, warps: np.ndarray) -> float:
    """How much harder joints accelerate when recordings have each other's pace, warps (N, T), and duration.

    The 98 % quantile over time of a joint's acceleration, over the geometric mean of what it is in the two recordings
    themselves: its median over the joints and over pairs of each recording with ``N_PARTNERS`` others. 1 for one.
    """
    clock = np.tile(np.linspace(0.0, 1.0, warps.shape[1]), (len(warps), 1))
    duration_s = motions.duration_s[:, None]
    usual = np.maximum(_hard_m_per_s2(_joints_m(motions, clock), clock * duration_s), STILL_M_PER_S2)
    joints, time_s, n = _joints_m(motions, warps), warps * duration_s, len(warps)
    partners = {max(1, round(k * n / (N_PARTNERS + 1))) for k in range(1, N_PARTNERS + 1)} - {n}
    ratios = [
        np.maximum(_hard_m_per_s2(joints, np.roll(time_s, shift, axis=0)), STILL_M_PER_S2)
        / np.sqrt(usual * np.roll(usual, shift, axis=0))
        for shift in sorted(partners)
    ]
    return float(np.median(ratios)) if ratios else 1.0


def postures_at(directions: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Postures (S, B, 3) of frames (T, B, 3), even in time, at moments own (S,) of own unit time.

    Along cubic splines of the vectors, made unit again: along geodesics, what is recorded at 30 frames a second would
    lose a tenth of its acceleration between the frames.
    """
    at = np.linspace(0.0, 1.0, len(directions))
    return sphere.normalise(CubicSpline(at, directions)(np.clip(own, 0.0, 1.0)))


def _joints_m(motions: MotionSet, warps: np.ndarray) -> np.ndarray:
    """(N, T, J, 3) joints on the common clock."""
    rows = []
    for motion, gamma in zip(motions.motions, warps):
        root, yaw = _on_clock(motion, gamma)
        posture = turn(resample(motion.directions, gamma), yaw[:, None])
        rows.append(motion.skeleton.positions(posture, motion.bone_length_m, root))
    return np.stack(rows)


def _hard_m_per_s2(joints_m: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """(N, J) 98 % quantile over time of the accelerations of joints (N, T, J, 3) at times (N, T)."""
    step_s = np.diff(time_s, axis=1)[..., None, None]
    speed = np.diff(joints_m, axis=1) / step_s
    acceleration = np.diff(speed, axis=1) / (0.5 * (step_s[:, 1:] + step_s[:, :-1]))
    return np.asarray(np.quantile(np.linalg.norm(acceleration, axis=-1), 0.98, axis=1))


def _aligned_warps(motions: MotionSet, settings: FitSettings, progress: Progress, penalty: float) -> np.ndarray:
    labels = Labels([motion.name for motion in motions.motions], motions.skeleton.bone_names)
    marks = np.clip(_mark_share(motions), 0.0, 1.0)
    marked = {"marks": marks, "mark_strength": settings.landmarks} if settings.landmarks else {}
    directions = [motion.directions for motion in motions.motions]
    n_times = min(settings.n_times or N_ALIGNED, N_ALIGNED)
    return align(directions, n_times=n_times, labels=labels, penalty=penalty, progress=progress, **marked).warps


def _mark_share(motions: MotionSet) -> np.ndarray:
    """(N, E) when the marks came, as a share of the own duration."""
    return motions.mark_s / motions.duration_s[:, None]


def _on_clock(motion: Motion, gamma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Path (T, 3) and heading (T,) of a motion at the common clock's times."""
    at = gamma * motion.duration_s
    course = CubicSpline(motion.time_s, np.column_stack([motion.root_m, motion.yaw_rad]))(at)
    return course[:, :3], course[:, 3]
